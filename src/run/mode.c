/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mode.h"

#include <math.h>

#include "functional.h"

/* Largest displacement, in widths of the layer, for which the mode counts as small. */
static const double small = 0.1;

PROBLEM_OWN(mode_start)

static void growing_during(const struct prepared *p, double times[2])
{
    const struct mode_start *start = mode_start_of(p);
    const struct layer_mode *mode = &start->mode;
    const double rate = cimag(mode->omega) / start->length;
    times[0] = log(2) / rate;
    times[1] = log(small * mode->layer.width / (start->amplitude * mode->displacement)) / rate;
}

static bool same(const struct layer *a, const struct layer *b)
{
    return a->gamma == b->gamma && a->k == b->k && a->width == b->width && a->rho == b->rho &&
           a->rho_step == b->rho_step && a->U == b->U && a->P == b->P && a->g == b->g &&
           a->periodic == b->periodic && a->wall == b->wall && a->pressure_node == b->pressure_node;
}

/* Finds the mode, or takes it from those that this thread found last: a search takes as long as a
 * short run, and a case is prepared when it is read, planned and run. */
static bool find(const struct layer *layer, struct layer_mode *mode)
{
    enum { KEPT = 4 };
    static _Thread_local struct layer_mode kept[KEPT];
    static _Thread_local size_t next;
    for (size_t i = 0; i < KEPT; i++)
        if (same(layer, &kept[i].layer)) {
            *mode = kept[i];
            return true;
        }
    if (!layer_mode_find(layer, mode)) return false;
    kept[next++ % KEPT] = *mode;
    return true;
}

enum status mode_prepare(struct prepared *p, const struct layer *layer, const double origin[2],
                         double length, double speed, struct settings *settings,
                         struct error *error)
{
    struct mode_start *start = (struct mode_start *)p->own.bytes;
    const double amplitude = settings_real(settings, SETTING_amplitude);
    const char *fault = layer_fault(layer);
    if (fault) return error_set(error, STATUS_BAD_INPUT, "%s", fault);
    const bool found = find(layer, &start->mode);
    if (!found && isnan(creal(start->mode.omega)))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a mode");
    if (!found)
        return error_set(error, STATUS_BAD_INPUT,
                         "waves=%g: no mode of %g waves in the box grows in a layer of width %g",
                         settings_real(settings, SETTING_waves),
                         settings_real(settings, SETTING_waves), length * layer->width);
    start->origin[0] = origin[0];
    start->origin[1] = origin[1];
    start->length = length;
    start->amplitude = amplitude * speed;
    const double most = small * layer->width / (2 * start->mode.displacement * speed);
    if (amplitude > 0 && amplitude < most) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "amplitude=%g: more than 0 and less than %.4g is needed, so that the mode can "
                     "grow from twice its start and still be small",
                     amplitude, most);
}

/* x in units of the mode. */
static void to_mode(const struct mode_start *start, const double x[3], double at[2])
{
    at[0] = (x[0] - start->origin[0]) / start->length;
    at[1] = (x[1] - start->origin[1]) / start->length;
}

void mode_sample(const struct prepared *p, const double x[3], double t, struct problem_state *state)
{
    const struct mode_start *start = mode_start_of(p);
    double at[2];
    to_mode(start, x, at);
    const struct layer_base base = layer_base(&start->mode.layer, at[1]);
    const struct layer_values q = layer_mode_values(&start->mode, at[0], at[1], t / start->length);
    const double a = start->amplitude, rho = base.rho + a * q.rho, P = base.P + a * q.p;
    *state = (struct problem_state){.rho = rho,
                                    .v = {base.U + a * q.v[0], a * q.v[1]},
                                    .P = P,
                                    .u = P / ((p->gamma - 1) * rho)};
}

/* ---- projection of a state on the mode ---- */

enum { BINS = 32 };

struct projection {
    double complex c, other; /* amplitudes of the mode and of the opposite parity */
    double noise;            /* rms of v_y without the mode over the rms of the mode */
    double error;            /* relative rms error of v_y(y) at the mode's wavelength */
};

/* Sums over all particles and over bins of the height. */
struct sums {
    double complex half[2]; /* the layer at y = 0 and its mirror image */
    double squares, all;
    double complex measured[BINS], exact[BINS];
    double volume[BINS];
};

static void add_particle(struct sums *sums, const struct mode_start *start, const double at[2],
                         double part, double volume, double vy)
{
    const double complex wave = cexp(-LAYER_I * start->mode.layer.k * at[0]);
    const double complex f = layer_mode_amplitude(&start->mode, at[1]).v;
    const int bin = (int)fmin(fmax(part * BINS, 0), BINS - 1);
    sums->half[start->mode.layer.periodic && at[1] > 0.25] += volume * vy * conj(f) * wave;
    sums->squares += volume * creal(f * conj(f));
    sums->all += volume * vy * vy;
    sums->measured[bin] += 2 * volume * vy * wave;
    sums->exact[bin] += volume * f;
    sums->volume[bin] += volume;
}

static struct projection project(const struct prepared *p, const struct snapshot *s)
{
    const struct mode_start *start = mode_start_of(p);
    struct sums sums = {0};
    for (size_t i = 0; i < s->n; i++) {
        double x[3], v[3], at[2];
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        to_mode(start, x, at);
        add_particle(&sums, start, at, (x[1] - p->domain.lo[1]) / domain_length(&p->domain, 1),
                     s->volume[i], v[1]);
    }
    struct projection of = {.c = 2 * (sums.half[0] + sums.half[1]) / sums.squares,
                            .other = 2 * (sums.half[0] - sums.half[1]) / sums.squares};
    /* the mean square of Re(c f) is |c f|^2/2; the rest is orthogonal */
    const double size = creal(of.c * conj(of.c)), mode = 0.5 * size * sums.squares;
    of.noise = sqrt(fabs(sums.all - mode) / mode);
    double off = 0, whole = 0;
    for (int b = 0; b < BINS; b++) {
        if (!(sums.volume[b] > 0)) continue;
        const double complex exact = of.c * sums.exact[b], jump = sums.measured[b] - exact;
        off += creal(jump * conj(jump)) / sums.volume[b];
        whole += creal(exact * conj(exact)) / sums.volume[b];
    }
    of.error = sqrt(off / whole);
    return of;
}

static double amplitude_measured(const struct prepared *p, const struct snapshot *s)
{
    return cabs(project(p, s).c);
}

static double amplitude_exact(const struct prepared *p, double t)
{
    const struct mode_start *start = mode_start_of(p);
    return start->amplitude * exp(cimag(start->mode.omega) * t / start->length);
}

static double error_measured(const struct prepared *p, const struct snapshot *s)
{
    return project(p, s).error;
}

static double noise_measured(const struct prepared *p, const struct snapshot *s)
{
    return project(p, s).noise;
}

static double other_measured(const struct prepared *p, const struct snapshot *s)
{
    const struct projection of = project(p, s);
    return cabs(of.other) / cabs(of.c);
}

static double rate_exact(const struct prepared *p)
{
    const struct mode_start *start = mode_start_of(p);
    return cimag(start->mode.omega) / start->length;
}

const struct functional mode_amplitude = {"mode_amplitude", NULL, amplitude_measured,
                                          amplitude_exact},
                        mode_error = {"mode_error", NULL, error_measured, functional_zero},
                        mode_noise = {"mode_noise", NULL, noise_measured, functional_zero},
                        mode_other_parity = {"other_parity", NULL, other_measured, functional_zero};

const struct growing mode_growing = {"growth_rate", amplitude_measured, growing_during, rate_exact};
