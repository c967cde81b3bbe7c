/* SPDX-License-Identifier: GPL-3.0-or-later
 * The isentropic vortex of Yee, Sandham & Djomehri 1999, of strength 5, in the middle of a periodic
 * box. It is smooth, so that the error has the order of the scheme. At the edge of a box of [-5, 5]
 * it still rotates with 2.4e-5, which limits the error from below. Particles of equal spacing whose
 * masses follow the density. */
#include <math.h>

#include "initial.h"
#include "problem.h"
#include "vortex.h"

static const double strength = 5;

/* The temperature at the centre, 1 - 1.72 (gamma - 1)/(2 gamma), is positive for every gamma. */
static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    (void)p, (void)settings, (void)error;
    return STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double dx = x[0] - p->window.centre[0], dy = x[1] - p->window.centre[1];
    const double R = hypot(dx, dy);
    const struct vortex_state s = vortex_yee(R, strength, p->gamma);
    (void)t;
    *state = (struct problem_state){.rho = s.rho,
                                    .v = {R > 0 ? -s.v * dy / R : 0, R > 0 ? s.v * dx / R : 0},
                                    .P = s.P,
                                    .u = s.P / ((p->gamma - 1) * s.rho)};
}

const struct problem problem_yee = {
    .member = {"yee", "a smooth vortex that stands still", "Yee, Sandham & Djomehri 1999"},
    .reference = "yee",
    .least_dim = 2,
    .most_dim = 2,
    .shifts = true,
    .carried = true,
    .steady = true,
    .circular = CIRCULAR_ROUND,
    .smooth = true,
    PROBLEM_KEYS({SETTING_equal_masses, ROLE_PARTICLES}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
};
