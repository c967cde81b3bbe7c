/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cold gas of density 1 that falls with speed 1 onto the middle of the box (Noh 1987): onto a plane
 * in 1D, an axis in 2D, a point in 3D. The gas is a ball of particles of equal masses in an empty
 * periodic box of twice its size, wide enough that images do not interact. This needs no inflow
 * boundary, and the edge of the ball has no influence, since the gas falls faster than any
 * signal. */
#include "noh.h"

#include <math.h>

#include "initial.h"
#include "problem.h"
#include "shells.h"

/* Initial pressure, too low to change the flow (Mach 800). */
static const double cold = 1e-6;

/* Radius of the ball at t = 0: half of the distance to the nearest end of the box. */
static double radius_of(const struct prepared *p)
{
    return 0.25 * domain_shortest(&p->domain);
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    const double part = 0.3 * radius_of(p);
    (void)error;
    if (!settings->value[SETTING_window].automatic || p->window.radius > 0) return STATUS_OK;
    if (p->domain.dim > 1) p->window.radius = part;
    for (int d = 0; d < p->domain.dim; d++) {
        p->window.lo[d] = p->window.centre[d] - part;
        p->window.hi[d] = p->window.centre[d] + part;
    }
    return STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double r = problem_radius(p, x);
    const struct noh_state s = noh_sample(p->gamma, p->domain.dim, r, t);
    const bool beyond = r >= radius_of(p) - t && r >= noh_shock(p->gamma, t);
    *state = (struct problem_state){0};
    if (!beyond) state->rho = s.rho, state->P = fmax(s.P, cold * pow(s.rho, p->gamma));
    for (int d = 0; d < p->domain.dim && r > 0; d++)
        state->v[d] = s.v * (x[d] - p->window.centre[d]) / r;
    if (!beyond) state->u = state->P / ((p->gamma - 1) * state->rho);
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    return initial_fill_ball(p, settings, radius_of(p), initial, error);
}

/* True until gas from the edge of the ball reaches the window or the shock. */
static bool holds(const struct prepared *p, double t)
{
    double far = 0;
    for (int d = 0; d < p->domain.dim; d++) {
        const double lo = p->window.centre[d] - p->window.lo[d];
        const double hi = p->window.hi[d] - p->window.centre[d];
        far = hypot(far, fmax(lo, hi));
    }
    if (p->window.radius > 0) far = fmin(far, p->window.radius);
    return fmax(far, noh_shock(p->gamma, t)) + t <= radius_of(p);
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: the gas is a ball of radius %g, whose edge falls into the window; "
                     "allowed: t_end <= %.4g, or a smaller window, or a wider box",
                     t, radius_of(p), longest);
}

/* ---- measures of the shock ---- */

static double inside_exact(const struct prepared *p, double t)
{
    return noh_sample(p->gamma, p->domain.dim, 0, t).rho;
}

/* Radius at which the density is half-way between the infalling gas and the gas at rest. */
static double shock_measured(const struct prepared *p, const struct snapshot *s)
{
    struct shells shells;
    const double R = noh_shock(p->gamma, s->time), dense = inside_exact(p, s->time);
    if (!(R > 0)) return 0;
    shells_make(&shells, p, s);
    return shells_crossing(&shells,
                           0.5 * (dense + noh_sample(p->gamma, p->domain.dim, R, s->time).rho));
}

static double shock_exact(const struct prepared *p, double t)
{
    return noh_shock(p->gamma, t);
}

/* Mean density behind the shock, excluding the overheated centre and the width of the shock. */
static double plateau_measured(const struct prepared *p, const struct snapshot *s)
{
    const double R = noh_shock(p->gamma, s->time);
    return R > 0 ? shells_mean(p, s, 0.25 * R, 0.75 * R) : 1;
}

/* Mean density at the centre. It is too low, since gas overheated by the first collision stays too
 * hot (Noh's "wall heating"). */
static double centre_measured(const struct prepared *p, const struct snapshot *s)
{
    const double R = noh_shock(p->gamma, s->time);
    return R > 0 ? shells_mean(p, s, 0, 0.25 * R) : 1;
}

static const struct functional shock_radius = {"shock_radius", NULL, shock_measured, shock_exact},
                               plateau = {"plateau", NULL, plateau_measured, inside_exact},
                               centre = {"centre_density", NULL, centre_measured, inside_exact};

const struct problem problem_noh = {
    .member = {"noh", "cold gas falls onto a plane, an axis or a point", "Noh 1987"},
    .reference = "noh",
    .least_dim = 1,
    .most_dim = 3,
    .shifts = true,
    .circular = CIRCULAR_RADIAL,
    .ends = {{.also = PROBLEM_END(OPEN)}, {.also = PROBLEM_END(OPEN)}, {.also = PROBLEM_END(OPEN)}},
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .holds = holds,
    .refuse = refuse,
    .functionals = {&shock_radius, &plateau, &centre},
};
