/* SPDX-License-Identifier: GPL-3.0-or-later
 * The blast of Sedov 1959: an energy of 1 in the middle of a periodic box of cold gas of density 1
 * at rest. Particles of equal masses; those within a few spacings of the centre share the energy by
 * a smooth weight, so that it falls into a point as their number grows. */
#include "sedov.h"

#include <math.h>

#include "initial_fill.h"
#include "problem.h"
#include "shells.h"

static const double energy = 1, density = 1;
/* Of a pressure so low that the shock does not know of it. */
static const double cold = 1e-6;
/* Radius of the hot spot in mean distances of particles. */
static const double hot_spacings = 2.5;

static const struct sedov *sedov_of(const struct prepared *p)
{
    return (const struct sedov *)p->own.bytes;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    (void)settings;
    const char *fault =
        sedov_solve(p->gamma, p->domain.dim, density, energy, (struct sedov *)p->own.bytes);
    return fault ? error_set(error, STATUS_BAD_INPUT, "no exact solution: %s", fault) : STATUS_OK;
}

/* At t = 0 the gas as it lies before the blast. */
static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double r = problem_radius(p, x);
    struct sedov_state s = {density, 0, 0};
    if (t > 0) s = sedov_sample(sedov_of(p), r, t);
    *state = (struct problem_state){.rho = s.rho, .P = fmax(s.P, cold)};
    for (int d = 0; d < p->domain.dim && r > 0; d++)
        state->v[d] = s.v * (x[d] - p->window.centre[d]) / r;
    state->u = s.rho > 0 ? state->P / ((p->gamma - 1) * s.rho) : 0;
}

/* (1 - q^2)^2, q = r over the hot spot's radius. */
static double weight_of(const struct prepared *p, const struct initial *initial, size_t i)
{
    double x[3] = {0}, volume = 1;
    for (int d = 0; d < initial->dim; d++) {
        x[d] = initial->x[d][i];
        volume *= domain_length(&p->domain, d);
    }
    const double spacing = pow(volume / (double)initial->n, 1. / initial->dim);
    const double q = problem_radius(p, x) / (hot_spacings * spacing);
    return q < 1 ? (1 - q * q) * (1 - q * q) : 0;
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    const enum status status = initial_fill(p, settings, initial, error);
    double sum = 0;
    for (size_t i = 0; !status && i < initial->n; i++)
        sum += initial->m[i] * weight_of(p, initial, i);
    for (size_t i = 0; !status && i < initial->n; i++)
        initial->u[i] += energy * weight_of(p, initial, i) / sum;
    return status;
}

/* The shock has not come near its images. */
static bool holds(const struct prepared *p, double t)
{
    double half = (double)INFINITY;
    for (int d = 0; d < p->domain.dim; d++) half = fmin(half, 0.5 * domain_length(&p->domain, d));
    return sedov_shock(sedov_of(p), t) <= 0.9 * half;
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: the box is periodic, and the shock comes to its ends (it would be "
                     "at %.4g); allowed: t_end <= %.4g, or a wider box",
                     t, sedov_shock(sedov_of(p), t), longest);
}

/* ---- what is seen of the shock ---- */

/* Where the density is half-way from the gas ahead to its own peak: a shock that is smeared and
 * too low has this in its middle all the same. */
static double shock_measured(const struct prepared *p, const struct snapshot *s)
{
    struct shells shells;
    if (!(s->time > 0)) return 0;
    shells_make(&shells, p, s);
    return shells_crossing(&shells, 0.5 * (density + shells_peak(&shells)));
}

static double shock_exact(const struct prepared *p, double t)
{
    return sedov_shock(sedov_of(p), t);
}

static double peak_measured(const struct prepared *p, const struct snapshot *s)
{
    struct shells shells;
    shells_make(&shells, p, s);
    return shells_peak(&shells);
}

static double peak_exact(const struct prepared *p, double t)
{
    return t > 0 ? density * (p->gamma + 1) / (p->gamma - 1) : density;
}

static const struct functional shock_radius = {"shock_radius", NULL, shock_measured, shock_exact},
                               peak = {"peak_density", NULL, peak_measured, peak_exact};

const struct problem problem_sedov = {
    .member = {"sedov", "the blast of a point-like explosion", "Sedov 1959"},
    .reference = "sedov",
    .least_dim = 2,
    .most_dim = 3,
    .circular = CIRCULAR_RADIAL,
    .singular = true,
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .holds = holds,
    .refuse = refuse,
    .random = initial_is_shaken,
    .functionals = {&shock_radius, &peak},
};
