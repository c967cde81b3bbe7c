/* SPDX-License-Identifier: GPL-3.0-or-later
 * A gas with a jump, for tests of initial states. Include after test.h. */
#pragma once

#include "keyed.h"
#include "problem.h"

/* Density of a gas that has a jump and varies everywhere. */
static inline double gas_density(const double x[3])
{
    return (x[0] < 0.3 ? 3 : 1) + 0.01 * x[0] + 0.5 * x[1] * x[1] + 0.25 * x[2];
}

static inline double gas_energy(const double x[3])
{
    return 3 + x[1] + 0.1 * x[0];
}

static inline void gas_sample(const struct prepared *p, const double x[3], double t,
                              struct problem_state *s)
{
    (void)p;
    *s = (struct problem_state){.rho = gas_density(x) * (1 + t),
                                .v = {x[0], 2 * x[0] - x[1] + t, 5 + x[2]},
                                .P = 1 + t,
                                .u = gas_energy(x) + t};
}

static const struct problem gas_problem = {.sample = gas_sample, .smooth = false};
