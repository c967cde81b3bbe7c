/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where the error of a Riemann problem comes from: its L1 norm split by regions of the exact
 * solution, and whether gas that no wave has reached is still as it was. */
#ifndef SPHPROOF_BUDGET_H
#define SPHPROOF_BUDGET_H

#include <jansson.h>
#include <stdbool.h>

#include "exact.h"
#include "simulation.h"

#define BUDGET_REGION_LIST(REGION)                                                                 \
    REGION(UNDISTURBED, "undisturbed") /* no wave has been here */                                 \
    REGION(FAN, "fan")                 /* inside a rarefaction, or within reach of its ends */     \
    REGION(PLATEAU, "plateau")         /* constant states between the waves; vacuum */             \
    REGION(CONTACT, "contact")         /* within reach of the contact */                           \
    REGION(SHOCK, "shock")             /* within reach of a shock */

enum region {
#define REGION(name, text) REGION_##name,
    BUDGET_REGION_LIST(REGION)
#undef REGION
        REGIONS
};
extern const char *const budget_regions[REGIONS];

/* How far a wave's numerical width reaches, in the particle's h. */
#define BUDGET_REACH 3.
/* How far ahead of every wave gas has to be for its rest to be demanded: in h (a shock's precursor
 * falls tenfold from particle to particle), and as a part of the way that the wave has run (a fan's
 * head is dispersed, over many h). */
#define BUDGET_STILL_WIDTHS 12.
#define BUDGET_STILL_WAY    0.25

struct budget {
    bool known; /* false: no Riemann problem */
    /* L1 = sum over regions; 0 where a region is not in the window */
    double l1[REGIONS][FIELDS];
    double still; /* max |v - v0|/c in undisturbed gas of the whole box; NaN: too few particles */
};

/* exact_values[f]: n numbers of field f at the particles. */
void budget_measure(const struct exact *exact, const double window[2], const struct snapshot *s,
                    const double *const *exact_values, struct budget *budget);

/* Adds a budget in JSON, times weight: for means. still: the largest. */
void budget_add(struct budget *budget, const json_t *json, double weight);

/* {"undisturbed": {"density", ...}, ..., "still"}; null where it is not known. New reference. */
json_t *budget_json(const struct budget *budget);

#endif
