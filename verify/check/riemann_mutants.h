/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wrong Riemann solvers and samplers, which the checks of the groups riemann and exact reject; the
 * lists of mutants in those checks say what is wrong with each. */
#ifndef CHECK_RIEMANN_MUTANTS_H
#define CHECK_RIEMANN_MUTANTS_H

#include "riemann_property.h"

#define RIEMANN_MUTANTS(MUTANT)                                                                    \
    MUTANT(negative_pressure)                                                                      \
    MUTANT(loose_root)                                                                             \
    MUTANT(swapped_velocity)                                                                       \
    MUTANT(two_shocks)                                                                             \
    MUTANT(gamma_fixed)                                                                            \
    MUTANT(isentropic_shock)                                                                       \
    MUTANT(shock_speed)                                                                            \
    MUTANT(isentrope_exponent)                                                                     \
    MUTANT(tail_speed)                                                                             \
    MUTANT(no_vacuum)                                                                              \
    MUTANT(vacuum_limit)                                                                           \
    MUTANT(vacuum_edge)                                                                            \
    MUTANT(left_at_rest)                                                                           \
    MUTANT(right_not_mirrored)                                                                     \
    MUTANT(fan_about_origin)                                                                       \
    MUTANT(fan_density)                                                                            \
    MUTANT(fan_velocity)                                                                           \
    MUTANT(fan_linear)                                                                             \
    MUTANT(fan_as_shock)                                                                           \
    MUTANT(no_contact)                                                                             \
    MUTANT(late)                                                                                   \
    MUTANT(star_at_start)

#define MUTANT(name) extern const struct riemann_subject riemann_mutant_##name;
RIEMANN_MUTANTS(MUTANT)
#undef MUTANT

/* An entry of a check's list of mutants. */
#define RIEMANN_MUTANT(name, fault)                                                                \
    {                                                                                              \
        "riemann_" #name, fault, &riemann_mutant_##name                                            \
    }

#endif
