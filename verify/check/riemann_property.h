/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a solution of a Riemann problem must satisfy (Toro 2009, chapters 3 and 4), measured without
 * the formulas that made it; random problems to measure it on. Defects are relative to the largest
 * terms of the relation, so that a few 1e-16 are round-off. */
#pragma once

#include <gsl/gsl_rng.h>

#include "riemann.h"

/* A solver under test. */
struct riemann_subject {
    const char *name;
    const char *(*solve)(double gamma, const struct riemann_state *left,
                         const struct riemann_state *right, struct riemann_solution *solution);
    struct riemann_state (*sample)(const struct riemann_solution *solution, double x, double x0,
                                   double t);
};

extern const struct riemann_subject riemann_reference; /* reference/riemann.h */

struct riemann_problem {
    double gamma;
    struct riemann_state left, right;
};

/* Random problems of all kinds: collisions, expansions up to vacuum and beyond, vacuum on a side,
 * equal pressures, weak waves, ratios of density and pressure up to 10^decades, gamma from 1.01 to
 * 11. */
struct riemann_problem riemann_random(gsl_rng *random, double decades);

struct riemann_defects {
    double mass, momentum, energy; /* across shocks: Rankine-Hugoniot */
    double isentrope, invariant;   /* across rarefactions */
    double speeds;                 /* heads v -+ c, tails v* -+ c*, contact v* */
    double order;                  /* waves in order, shocks compress, rarefactions expand */
};

/* All defects of a solution; NaN for a missing figure that must exist. */
struct riemann_defects riemann_defects_of(const struct riemann_solution *solution);

/* 1 if the solution has a vacuum where there is none or the reverse, or a star value with
 * vacuum. */
double riemann_vacuum_defect(const struct riemann_solution *solution);

/* Inside the fans, at time t around x0: v -+ c = (x - x0)/t, isentrope and Riemann invariant; at
 * their ends: continuity. 0 where there is no fan. */
double riemann_fan_defect(const struct riemann_subject *subject,
                          const struct riemann_solution *solution, double x0, double t);

/* The mirror image (x -> -x), and the same problem seen from a frame that moves with -dv. */
struct riemann_problem riemann_mirrored(const struct riemann_problem *problem);
struct riemann_problem riemann_boosted(const struct riemann_problem *problem, double dv);

/* The same transformations of a solution (star values, waves and speeds; the states stay). */
struct riemann_solution riemann_solution_mirrored(const struct riemann_solution *solution);
struct riemann_solution riemann_solution_boosted(const struct riemann_solution *solution,
                                                 double dv);

/* Largest relative difference of star values and speeds; 1 if kinds of waves differ. Differences of
 * speeds are relative to `speed`. */
double riemann_difference(const struct riemann_solution *a, const struct riemann_solution *b,
                          double speed);

/* The largest of |v| and c of a problem. */
double riemann_speed_scale(const struct riemann_problem *problem);

/* Wrong Riemann solvers and samplers, which the checks of the groups riemann and exact reject; the
 * lists of mutants in those checks say what is wrong with each. */
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
