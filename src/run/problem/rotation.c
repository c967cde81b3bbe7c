/* SPDX-License-Identifier: GPL-3.0-or-later
 * A disc of gas that rotates like a solid body and expands into a vacuum (Dyson 1968); loss of
 * rotation is error. Particles of equal masses in an empty periodic box of 2.5 times the size of
 * the disc, wide enough that images do not interact. */
#include <math.h>

#include "disc.h"
#include "initial.h"
#include "problem.h"

static const double spin = 1, middle_pressure = 0.25; /* of a disc of radius 1 */

/* Radius of the disc at t = 0, the unit of length. */
static double unit_of(const struct prepared *p)
{
    return 0.2 * domain_shortest(&p->domain);
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    if (settings->value[SETTING_window].automatic && p->window.radius == 0)
        p->window.radius = unit_of(p);
    if (fabs(p->gamma - 2) <= 1e-12) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "gamma=%g: the expansion of a spinning disc is known for gamma=2", p->gamma);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double dx = x[0] - p->window.centre[0], dy = x[1] - p->window.centre[1];
    const double r = hypot(dx, dy), unit = unit_of(p);
    const struct disc_state s = disc_sample(spin, middle_pressure, r / unit, t);
    *state = (struct problem_state){.rho = s.rho, .P = s.P * unit * unit};
    if (s.rho > 0) state->u = state->P / ((p->gamma - 1) * s.rho);
    if (!(r > 0)) return;
    state->v[0] = (dx * s.v_out - dy * s.v_along) * unit / r;
    state->v[1] = (dy * s.v_out + dx * s.v_along) * unit / r;
}

static enum status fill(const struct prepared *p, const struct settings *settings,
                        struct initial *initial, struct error *error)
{
    return initial_fill_ball(p, settings, unit_of(p), initial, error);
}

static bool holds(const struct prepared *p, double t)
{
    (void)p;
    return disc_radius(spin, middle_pressure, t) <= 2.25; /* the end of the box is at 2.5 */
}

static enum status refuse(const struct prepared *p, double t, double longest, struct error *error)
{
    (void)p;
    return error_set(error, STATUS_BAD_INPUT,
                     "t_end=%g: the box is periodic, and the disc comes to its ends; allowed: "
                     "t_end <= %.4g, or a wider box",
                     t, longest);
}

/* ---- sums over all particles: radius and rotation speed of the disc ---- */

struct sums {
    double mass, inertia, turning;
};

static struct sums sums_of(const struct prepared *p, const struct snapshot *s)
{
    struct sums sums = {0};
    for (size_t i = 0; i < s->n; i++) {
        const double dx = s->x[0][i] - p->window.centre[0], dy = s->x[1][i] - p->window.centre[1];
        sums.mass += s->m[i];
        sums.inertia += s->m[i] * (dx * dx + dy * dy);
        sums.turning += s->m[i] * (dx * s->v[1][i] - dy * s->v[0][i]);
    }
    return sums;
}

/* For a uniform disc the mean of r^2 is half of the squared radius. */
static double radius_measured(const struct prepared *p, const struct snapshot *s)
{
    const struct sums sums = sums_of(p, s);
    return sqrt(2 * sums.inertia / sums.mass);
}

static double radius_exact(const struct prepared *p, double t)
{
    return unit_of(p) * disc_radius(spin, middle_pressure, t);
}

static double speed_measured(const struct prepared *p, const struct snapshot *s)
{
    const struct sums sums = sums_of(p, s);
    return sums.turning / sums.inertia;
}

static double speed_exact(const struct prepared *p, double t)
{
    const double a = disc_radius(spin, middle_pressure, t);
    (void)p;
    return spin / (a * a);
}

static const struct functional radius = {"disc_radius", NULL, radius_measured, radius_exact},
                               speed = {"angular_speed", NULL, speed_measured, speed_exact};

const struct problem problem_rotation = {
    .member = {"rotation", "a spinning disc flies apart into a vacuum", "Dyson 1968"},
    .reference = "disc",
    .least_dim = 2,
    .most_dim = 2,
    .circular = CIRCULAR_ROUND,
    .ends = {{.also = PROBLEM_END(OPEN)}, {.also = PROBLEM_END(OPEN)}, {.also = PROBLEM_END(OPEN)}},
    .prepare = prepare,
    .sample = sample,
    .fill = fill,
    .holds = holds,
    .refuse = refuse,
    .functionals = {&radius, &speed},
};
