/* SPDX-License-Identifier: GPL-3.0-or-later
 * Places in [0, 1[ where a formula is likely to change, and their neighbours down to the last
 * digit: the ends of the pieces, short decimals, fractions, and the numbers that stand in a
 * plug-in's own code (with those that follow from a comparison of 1 - q or of q^2). A fault of any
 * width that begins or ends there is met, however narrow. */
#pragma once

#include "pieces.h"

struct places {
    double *q; /* n of them, ascending */
    int n, centres;
};

/* Without memory there are none (n = 0). Release with places_free. */
void places_make(struct places *places, const struct pieces *pieces);
void places_free(struct places *places);

/* A number in [0, 1[, the i-th of the sequence that seed names (splitmix64, Steele et al. 2014). */
double places_random(uint64_t seed, uint64_t i);

/* The numbers in ]0, 1[ among the constants of a compiled file, doubles and floats, malloced; their
 * number is returned, at most PLACES_CONSTANTS_MAX. 0: none, or the file cannot be read. */
enum { PLACES_CONSTANTS_MAX = 4096 };
int places_constants(const char *path, double **constants);
