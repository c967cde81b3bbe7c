/* SPDX-License-Identifier: GPL-3.0-or-later
 * Positions in [0, 1[ where a formula is likely to change, and their neighbours down to the last
 * digit: ends of the pieces, short decimals, fractions, and numbers in the code of a plug-in (and
 * those that follow from a comparison of 1 - q or q^2). They find a fault that begins or ends
 * there, however narrow. */
#pragma once

#include "pieces.h"

/* Finds the places of these pieces, which own them, for pieces_find. STATUS_ENVIRONMENT: no memory.
 */
enum status places_find(struct pieces *pieces, struct error *error);

/* The i-th random number in [0, 1[ of the sequence for seed (splitmix64, Steele et al. 2014). */
double places_random(uint64_t seed, uint64_t i);

/* Finds the numbers in ]0, 1[ among the constants of a compiled file, doubles and floats; the
 * caller frees them. Returns their number, at most PLACES_CONSTANTS_MAX. 0: none, or the file
 * cannot be read. */
enum { PLACES_CONSTANTS_MAX = 4096 };
int places_constants(const char *path, double **constants);
