/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

#include "equal_masses.h"
#include "lattice.h"
#include "particle_file.h"
#include "problem.h"

enum status initial_allocate(struct initial *initial, int dim, size_t n, struct error *error)
{
    const size_t arrays = 2 * (size_t)dim + 3;
    double *next = malloc(arrays * n * sizeof(double));
    if (!next) return error_set(error, STATUS_ENVIRONMENT, "no memory for n=%zu particles", n);
    *initial = (struct initial){.dim = dim, .n = n, .storage = next};
    for (int d = 0; d < dim; d++, next += n) initial->x[d] = next;
    for (int d = 0; d < dim; d++, next += n) initial->v[d] = next;
    initial->m = next;
    initial->u = next + n;
    initial->rho = next + 2 * n;
    return STATUS_OK;
}

/* Brings every second particle of a line close to its neighbour on the same side of the jump. */
static void pair_up(struct initial *initial, const struct settings *settings)
{
    const int lattice = settings_choice(settings, SETTING_lattice);
    if (lattice != LATTICE_CLUSTERED && lattice != LATTICE_COINCIDENT) return;
    const double part = lattice == LATTICE_CLUSTERED ? 0.05 : 0;
    double *x = initial->x[0];
    for (size_t i = 0; i + 1 < initial->n; i++) {
        if (initial->rho[i] != initial->rho[i + 1] || initial->m[i] != initial->m[i + 1]) continue;
        const double middle = 0.5 * (x[i] + x[i + 1]), half = part * (x[i + 1] - x[i]);
        x[i] = middle - half;
        x[i + 1] = middle + half;
        i++;
    }
}

bool initial_is_shaken(const struct settings *settings)
{
    return settings_real(settings, SETTING_jitter) > 0 ||
           settings_choice(settings, SETTING_lattice) == LATTICE_RANDOM ||
           settings_choice(settings, SETTING_lattice) == LATTICE_GLASS;
}

static double spacing(const struct initial *initial, size_t i)
{
    const double volume = initial->m[i] / initial->rho[i];
    return initial->dim == 1 ? volume : initial->dim == 2 ? sqrt(volume) : cbrt(volume);
}

/* Round the box, or back from an end that is none. */
static double into_box(const struct prepared *p, int d, double x)
{
    const double lo = p->domain.lo[d], hi = p->domain.hi[d];
    const bool periodic = p->boundary[d] == BOUNDARY_PERIODIC;
    if (x < lo) return periodic ? x + (hi - lo) : lo + (lo - x);
    if (x >= hi) return periodic ? x - (hi - lo) : hi - (x - hi);
    return x;
}

/* Moves each particle in each direction by up to jitter times its share of the space: on a line
 * their order stays. */
static enum status shake(struct initial *initial, const struct prepared *p,
                         const struct settings *settings)
{
    const struct domain *domain = &p->domain;
    const double jitter = settings_real(settings, SETTING_jitter);
    if (!(jitter > 0)) return STATUS_OK;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (!random) return STATUS_ENVIRONMENT;
    gsl_rng_set(random, (unsigned long)settings_real(settings, SETTING_seed));
    for (size_t i = 0; i < initial->n; i++)
        for (int d = 0; d < initial->dim; d++) {
            double *x = &initial->x[d][i];
            *x += jitter * spacing(initial, i) * (2 * gsl_rng_uniform(random) - 1);
            if (initial->dim > 1) *x = into_box(p, d, *x);
            *x = fmin(fmax(*x, domain->lo[d]), nextafter(domain->hi[d], domain->lo[d]));
        }
    gsl_rng_free(random);
    return STATUS_OK;
}

/* What the sample says of particle i; its mass stays. */
void initial_sample(struct initial *initial, const struct prepared *p, size_t i)
{
    struct problem_state state;
    double x[3] = {0};
    for (int d = 0; d < initial->dim; d++) x[d] = initial->x[d][i];
    p->problem->sample(p, x, 0, &state);
    for (int d = 0; d < initial->dim; d++) initial->v[d][i] = state.v[d];
    initial->u[i] = state.u;
    initial->rho[i] = state.rho;
}

enum status initial_lay(struct initial *initial, const struct prepared *p,
                        const struct lattice_plan *plan, size_t first,
                        const struct settings *settings, struct error *error)
{
    double *x[3] = {NULL}, share = 1. / (double)plan->n;
    for (int d = 0; d < initial->dim; d++) {
        x[d] = initial->x[d] + first;
        share *= domain_length(&plan->box, d);
    }
    if (lattice_points(plan, (unsigned long)settings_real(settings, SETTING_seed), x, error))
        return error->status;
    for (size_t i = first; i < first + plan->n; i++) {
        initial_sample(initial, p, i);
        initial->m[i] = initial->rho[i] * share;
    }
    return STATUS_OK;
}

enum status initial_fill(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error)
{
    struct lattice_plan plan;
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    if (settings_choice(settings, SETTING_equal_masses))
        return equal_masses_fill(p, settings, initial, error);
    if (lattice_plan_make(&plan, &p->domain, kind, n, error) ||
        initial_allocate(initial, p->domain.dim, plan.n, error))
        return error->status;
    return initial_lay(initial, p, &plan, 0, settings, error);
}

static void add_boost(struct initial *initial, const struct prepared *p)
{
    for (int d = 0; d < initial->dim; d++)
        for (size_t i = 0; i < initial->n; i++) initial->v[d][i] += p->boost[d];
}

void initial_keep(struct initial *initial, size_t first, initial_wanted *wanted,
                  const void *context)
{
    size_t kept = first;
    for (size_t i = first; i < initial->n; i++) {
        double x[3] = {0};
        for (int d = 0; d < initial->dim; d++) x[d] = initial->x[d][i];
        if (!wanted(context, x)) continue;
        for (int d = 0; d < initial->dim; d++) {
            initial->x[d][kept] = x[d];
            initial->v[d][kept] = initial->v[d][i];
        }
        initial->m[kept] = initial->m[i];
        initial->u[kept] = initial->u[i];
        initial->rho[kept++] = initial->rho[i];
    }
    initial->n = kept;
}

static bool in_window(const void *context, const double x[3])
{
    return window_contains(context, x);
}

enum status initial_fill_ball(const struct prepared *p, const struct settings *settings,
                              double radius, struct initial *initial, struct error *error)
{
    static const double parts[] = {0, 1, M_PI / 4, M_PI / 6}; /* of the box around it */
    const int dim = p->domain.dim;
    const enum lattice kind = (enum lattice)settings_choice(settings, SETTING_lattice);
    const size_t n = (size_t)round(settings_real(settings, SETTING_n) / parts[dim]);
    struct domain around = p->domain;
    struct window ball = p->window;
    struct lattice_plan plan;
    ball.radius = radius;
    for (int d = 0; d < dim; d++) {
        around.lo[d] = ball.lo[d] = ball.centre[d] - radius;
        around.hi[d] = ball.hi[d] = ball.centre[d] + radius;
    }
    if (lattice_plan_make(&plan, &around, kind, n, error) ||
        initial_allocate(initial, dim, plan.n, error))
        return error->status;
    if (initial_lay(initial, p, &plan, 0, settings, error)) return error->status;
    initial_keep(initial, 0, in_window, &ball);
    return STATUS_OK;
}

/* In 2D and 3D particles that jitter moves carry the flow of where they come to be: displaced
 * particles, not a noisy gas. Beside a jump they stay what they are. */
static void resample(struct initial *initial, const struct prepared *p,
                     const struct settings *settings)
{
    if (initial->dim == 1) return;
    for (size_t i = 0; i < initial->n; i++)
        if (p->problem->smooth && settings_real(settings, SETTING_jitter) > 0)
            initial_sample(initial, p, i);
    add_boost(initial, p);
}

enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error)
{
    *initial = (struct initial){0};
    const char *file = settings->file;
    const enum status status = *file ? particle_file_start(file, p, initial, error)
                                     : p->problem->fill(p, settings, initial, error);
    if (status) {
        initial_free(initial);
        return status;
    }
    if (*file) {
        add_boost(initial, p);
        return STATUS_OK;
    }
    pair_up(initial, settings);
    if (shake(initial, p, settings)) {
        initial_free(initial);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for random numbers");
    }
    resample(initial, p, settings);
    return STATUS_OK;
}

void initial_free(struct initial *initial)
{
    free(initial->storage);
    *initial = (struct initial){0};
}
