/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that fill a unit cube evenly but without a lattice: the sequence of Sobol 1967, by GSL,
 * randomised by a seed. */
#pragma once

#include <gsl/gsl_qrng.h>
#include <stdint.h>

enum { QUASI_RANDOM_DIM_MAX = 4 };

struct quasi_random {
    int dim;
    gsl_qrng *sequence;
    uint32_t digits[QUASI_RANDOM_DIM_MAX]; /* mask of the flipped binary digits, 30 bits */
    double shift[QUASI_RANDOM_DIM_MAX];    /* in [0, 1) */
};

/* Creates the sequence of a seed. Every seed but the first flips binary digits of the coordinates
 * (a digital shift, Owen 2003), which keeps the points even and makes the arrangement depend on the
 * seed. All seeds shift the points periodically by a random vector. NULL: no memory. Free with
 * quasi_random_destroy. */
struct quasi_random *quasi_random_create(int dim, unsigned long seed);
void quasi_random_destroy(struct quasi_random *random);

/* The next point; coordinates in [0, 1). */
void quasi_random_next(struct quasi_random *random, double *point);
