/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that fill a unit cube evenly without a lattice: Sobol 1967, by GSL, randomised by a seed.
 */
#pragma once

#include <gsl/gsl_qrng.h>
#include <stdint.h>

enum { QUASI_RANDOM_DIM_MAX = 4 };

struct quasi_random {
    int dim;
    gsl_qrng *sequence;
    uint32_t digits[QUASI_RANDOM_DIM_MAX]; /* binary ones that are exchanged, of 30 */
    double shift[QUASI_RANDOM_DIM_MAX];    /* from 0 to 1 */
};

/* The sequence of a seed. Every seed but the first exchanges binary digits of the coordinates (a
 * digital shift, Owen 2003), which keeps the points even and gives each seed an arrangement of its
 * own; all shift the cube round by random lengths. NULL: no memory. To be destroyed by
 * quasi_random_destroy. */
struct quasi_random *quasi_random_create(int dim, unsigned long seed);
void quasi_random_destroy(struct quasi_random *random);

/* Writes the coordinates of the next point, from 0 up to, but not, 1. */
void quasi_random_next(struct quasi_random *random, double *point);
