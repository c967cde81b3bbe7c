/* SPDX-License-Identifier: GPL-3.0-or-later
 * The vortex of Gresho & Chan 1990 in the middle of a periodic box: a steady flow, so that any
 * change is error. Particles of equal masses. */
#include <math.h>

#include "functional.h"
#include "initial.h"
#include "problem.h"
#include "vortex.h"

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    (void)settings;
    for (int d = 0; d < 2; d++)
        if (!(domain_length(&p->domain, d) >= 0.8))
            return error_set(error, STATUS_BAD_INPUT,
                             "lo=%g hi=%g: the vortex has a diameter of 0.8 and does not fit",
                             p->domain.lo[d], p->domain.hi[d]);
    return STATUS_OK;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double dx = x[0] - p->window.centre[0], dy = x[1] - p->window.centre[1];
    const double R = hypot(dx, dy);
    const struct vortex_state s = vortex_gresho(R);
    (void)t;
    *state = (struct problem_state){.rho = s.rho,
                                    .v = {R > 0 ? -s.v * dy / R : 0, R > 0 ? s.v * dx / R : 0},
                                    .P = s.P,
                                    .u = s.P / ((p->gamma - 1) * s.rho)};
}

/* ---- mean error over the particles with R < 0.5, as published for other codes ---- */

static double disc_measured(const struct prepared *p, const struct snapshot *s)
{
    double sum = 0, n = 0;
    for (size_t i = 0; i < s->n; i++) {
        double x[3], v[3], azimuthal, radial;
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        problem_circular(p, x, v, &azimuthal, &radial);
        const double R = hypot(x[0] - p->window.centre[0], x[1] - p->window.centre[1]);
        if (!(R < 0.5)) continue;
        sum += fabs(azimuthal - vortex_gresho(R).v);
        n++;
    }
    return sum / n;
}

/* Highest azimuthal speed: exactly 1, but only on a circle where few particles are. */
static double peak_measured(const struct prepared *p, const struct snapshot *s)
{
    double peak = 0;
    for (size_t i = 0; i < s->n; i++) {
        double x[3], v[3], azimuthal, radial;
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        problem_circular(p, x, v, &azimuthal, &radial);
        peak = fmax(peak, azimuthal);
    }
    return peak;
}

static const struct functional disc_error = {"disc_error", NULL, disc_measured, functional_zero},
                               peak = {"peak_velocity", NULL, peak_measured, functional_one};

const struct problem problem_gresho = {
    .member = {"gresho", "a vortex with kinks that stands still", "Gresho & Chan 1990"},
    .reference = "gresho",
    .least_dim = 2,
    .most_dim = 2,
    .shifts = true,
    .carried = true,
    .steady = true,
    .circular = CIRCULAR_ROUND,
    .smooth = true,
    .ends = {PROBLEM_WALLS, PROBLEM_WALLS},
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&disc_error, &peak},
};
