/* SPDX-License-Identifier: GPL-3.0-or-later
 * A liquid at rest under gravity along y, from the bottom of the box up to its surface at the top,
 * for other codes: P = sound^2 (rho - rho0) and dP/dy = g rho give rho = rho0 exp(g (y -
 * top)/sound^2), g < 0 (Landau & Lifshitz 1987, section 3). Particles of equal spacing, whose
 * masses follow the density. */
#include <math.h>

#include "functional.h"
#include "initial.h"
#include "liquid_problem.h"

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    *(struct liquid *)p->own.bytes = liquid_of(settings);
    return liquid_check_gravity(p, settings, error);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct liquid *of = (const struct liquid *)p->own.bytes;
    const double square = of->sound * of->sound;
    (void)t;
    *state = liquid_state(of, p->gamma);
    state->rho = of->rho0 * exp(p->gravity[1] * (x[1] - p->domain.hi[1]) / square);
    state->P = square * (state->rho - of->rho0);
}

const struct problem problem_hydrostatic = {
    .member = {"hydrostatic", "a liquid at rest under gravity", "Landau & Lifshitz 1987"},
    .reference = "hydrostatic",
    .least_dim = 2,
    .most_dim = 3,
    .smooth = true,
    .heavy = true,
    .liquid = true,
    .unknown = {[FIELD_INTERNAL_ENERGY] = true},
    .ends = {{.also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED) | PROBLEM_END(OPEN)},
             {BOUNDARY_REFLECTING, PROBLEM_END(FIXED) | PROBLEM_END(OPEN)},
             {.also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED) | PROBLEM_END(OPEN)}},
    PROBLEM_KEYS(LIQUID_KEYS),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&functional_velocity_rms},
};
