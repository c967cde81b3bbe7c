/* SPDX-License-Identifier: GPL-3.0-or-later
 * A simple wave that travels to the right through a uniform gas; exact at any amplitude until it
 * breaks (Landau & Lifshitz 1987, section 101). `waves` wavelengths fit the box, in 2D and 3D along
 * a `direction` of integers, which makes the wave periodic. Particles of equal masses whose
 * positions represent the density exactly. */
#include "initial.h"
#include "simple_wave.h"

#include <math.h>

#include "functional.h"
#include "problem.h"

struct plane_wave {
    struct simple_wave wave;
    double n[3]; /* unit vector along the wave */
};
_Static_assert(sizeof(struct plane_wave) <= PROBLEM_OWN_BYTES, "a wave fits");

static const struct simple_wave *wave_of(const struct prepared *p)
{
    return &((const struct plane_wave *)p->own.bytes)->wave;
}

static const double *direction_of(const struct prepared *p)
{
    return ((const struct plane_wave *)p->own.bytes)->n;
}

/* Distance of x from the domain's corner along the wave. */
static double along(const struct prepared *p, const double x[3])
{
    const double *n = direction_of(p);
    if (p->domain.dim == 1) return x[0] - p->domain.lo[0];
    double s = 0;
    for (int d = 0; d < p->domain.dim; d++) s += n[d] * (x[d] - p->domain.lo[d]);
    return s;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct plane_wave *plane = (struct plane_wave *)p->own.bytes;
    struct simple_wave *wave = &plane->wave;
    const double *gas = settings->value[SETTING_background].real;
    if (problem_check_state(settings, SETTING_background, error)) return error->status;
    *wave = (struct simple_wave){.gamma = p->gamma,
                                 .rho0 = gas[0],
                                 .v0 = gas[1],
                                 .P0 = gas[2],
                                 .amplitude = settings_real(settings, SETTING_amplitude)};
    if (problem_direction(p, settings, plane->n, &wave->length, error)) return error->status;
    if (p->domain.dim == 1) wave->length = domain_length(&p->domain, 0); /* exactly */
    wave->length /= settings_real(settings, SETTING_waves);
    const char *fault = simple_wave_fault(wave);
    return fault ? error_set(error, STATUS_BAD_INPUT, "no exact solution: %s", fault) : STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct simple_wave_state s = simple_wave_sample(wave_of(p), along(p, x), t);
    *state = (struct problem_state){.rho = s.rho, .v = {s.v}, .P = s.P, .u = s.u};
    for (int d = 0; p->domain.dim > 1 && d < p->domain.dim; d++)
        state->v[d] = s.v * direction_of(p)[d];
}

/* Position x (from lo) such that the mass between lo and x equals `mass`: Newton's method on rho0
 * (x + A (1 - cos k x)/k), whose slope is at least rho0 (1 - A). */
static double wave_position(const struct simple_wave *wave, double mass)
{
    const double k = 2 * M_PI / wave->length;
    double x = mass / wave->rho0;
    for (int i = 0; i < 50; i++) {
        const double excess = x + wave->amplitude * (1 - cos(k * x)) / k - mass / wave->rho0;
        const double step = excess / (1 + wave->amplitude * sin(k * x));
        x -= step;
        if (fabs(step) <= 1e-16 * wave->length) break;
    }
    return x;
}

/* Lattice points, displaced along the wave as in 1D. */
static enum status fill_cloud(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error)
{
    const struct simple_wave *wave = wave_of(p);
    const enum status status = initial_fill(p, settings, initial, error);
    double mass = wave->rho0;
    for (int d = 0; d < p->domain.dim; d++) mass *= domain_length(&p->domain, d);
    for (size_t i = 0; !status && i < initial->n; i++) {
        double x[3] = {0};
        for (int d = 0; d < initial->dim; d++) x[d] = initial->x[d][i];
        const double s = along(p, x), shift = wave_position(wave, s * wave->rho0) - s;
        for (int d = 0; d < initial->dim; d++)
            initial->x[d][i] = domain_wrap(&p->domain, d, x[d] + shift * direction_of(p)[d]);
        initial_sample(initial, p, i);
        initial->m[i] = mass / (double)initial->n;
    }
    return status;
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    if (p->domain.dim > 1) return fill_cloud(p, settings, initial, error);
    const struct simple_wave *wave = wave_of(p);
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    const double lo = p->domain.lo[0], mass = wave->rho0 * (p->domain.hi[0] - lo) / (double)n;
    if (initial_allocate(initial, 1, n, error)) return error->status;
    for (size_t i = 0; i < n; i++) {
        initial->m[i] = mass;
        initial->x[0][i] = lo + wave_position(wave, ((double)i + 0.5) * mass);
        initial_sample(initial, p, i);
    }
    return STATUS_OK;
}

static bool holds(const struct prepared *p, double t)
{
    return t < simple_wave_breaking_time(wave_of(p));
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    (void)p;
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: the wave breaks at %.6g and has no exact solution from there "
                     "on; allowed: t_end below that",
                     t, longest);
}

/* ---- amplitude of the density's first Fourier mode, relative to the background ---- */

enum { MODE_POINTS = 1024 };

/* Sums of a mode: cosine, sine, volume. */
struct mode {
    double a, b, volume;
};

static void mode_add(struct mode *mode, const struct prepared *p, const double x[3], double volume,
                     double rho)
{
    const struct simple_wave *wave = wave_of(p);
    const double phase = 2 * M_PI * along(p, x) / wave->length;
    mode->a += volume * (rho - wave->rho0) * cos(phase);
    mode->b += volume * (rho - wave->rho0) * sin(phase);
    mode->volume += volume;
}

static double mode_size(const struct mode *mode, const struct prepared *p)
{
    return 2 * hypot(mode->a, mode->b) / mode->volume / wave_of(p)->rho0;
}

static double mode_measured(const struct prepared *p, const struct snapshot *s)
{
    struct mode mode = {0};
    for (size_t i = 0; i < s->n; i++) {
        double x[3];
        problem_position(p, s, i, x);
        mode_add(&mode, p, x, s->volume[i], s->rho[i]);
    }
    return mode_size(&mode, p);
}

static double mode_exact(const struct prepared *p, double t)
{
    const bool line = p->domain.dim == 1; /* along the wave, over its wavelength */
    const double length = line ? domain_length(&p->domain, 0) : wave_of(p)->length;
    const double step = length / MODE_POINTS;
    struct mode mode = {0};
    for (int i = 0; i < MODE_POINTS; i++) { /* smooth and periodic: converges exponentially */
        const double way = (i + 0.5) * step;
        struct problem_state state;
        double x[3] = {p->domain.lo[0] + way};
        for (int d = 0; !line && d < p->domain.dim; d++)
            x[d] = p->domain.lo[d] + way * direction_of(p)[d];
        sample(p, x, t, &state);
        mode_add(&mode, p, x, step, state.rho);
    }
    return mode_size(&mode, p);
}

static const struct functional mode_amplitude = {"mode_amplitude", NULL, mode_measured, mode_exact};

const struct problem problem_sound_wave = {
    .member = {"sound_wave", "a simple wave that runs to the right", "Landau & Lifshitz 1987"},
    .reference = "simple_wave",
    .least_dim = 1,
    .most_dim = 3,
    .carried = true,
    .smooth = true,
    PROBLEM_KEYS({SETTING_background, ROLE_NEEDED}, {SETTING_amplitude, ROLE_NEEDED},
                 {SETTING_waves, ROLE_OPTIONAL}, {SETTING_direction, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .holds = holds,
    .refuse = refuse,
    .functionals = {&functional_mean_internal_energy, &functional_mean_pressure, &mode_amplitude},
};
