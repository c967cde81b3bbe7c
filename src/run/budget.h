/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where the error of a run comes from: its L1 norm split by the regions of its problem (problem.h),
 * and whether gas that no wave has reached is still as it was. */
#ifndef SPHPROOF_BUDGET_H
#define SPHPROOF_BUDGET_H

#include <jansson.h>

#include "problem.h"

/* How far a wave's numerical width reaches, in the particle's h. */
#define BUDGET_REACH 3.

struct budget {
    const struct regions *regions; /* NULL: the problem has none */
    /* L1 = sum over regions; 0 where a region is not in the window */
    double l1[PROBLEM_REGIONS_MAX][FIELDS];
    double still; /* max |v - v0|/c in undisturbed gas of the whole box; NaN: too few particles */
};

/* exact_values[f]: n numbers of field f at the particles. */
void budget_measure(const struct prepared *p, const struct snapshot *s,
                    const double *const *exact_values, struct budget *budget);

/* Adds a budget in JSON, by such regions (NULL: none), times weight: for means. still: the
 * largest. */
void budget_add(struct budget *budget, const struct regions *regions, const json_t *json,
                double weight);

/* {"undisturbed": {"density", ...}, ..., "still"}; null where there are no regions. New
 * reference. */
json_t *budget_json(const struct budget *budget);

#endif
