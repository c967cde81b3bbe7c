/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "quasi_random.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>

/* GSL's sequence consists of integer multiples of 1/RANGE. */
#define RANGE (UINT32_C(1) << 30)

struct quasi_random *quasi_random_create(int dim, unsigned long seed)
{
    /* odd and without a pattern: from the golden ratio and the roots of 2, 3 and 5 */
    static const uint32_t scatter[QUASI_RANDOM_DIM_MAX] = {0x9e3779b9, 0x6a09e667, 0xbb67ae85,
                                                           0x3c6ef373};
    struct quasi_random *random = calloc(1, sizeof *random);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_qrng *sequence = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim);
    if (!random || !generator || !sequence) {
        if (sequence) gsl_qrng_free(sequence);
        gsl_rng_free(generator);
        free(random);
        return NULL;
    }
    random->dim = dim;
    random->sequence = sequence;
    gsl_rng_set(generator, seed);
    for (int d = 0; d < dim; d++) {
        random->shift[d] = gsl_rng_uniform(generator);
        random->digits[d] = ((uint32_t)seed - 1) * scatter[d] % RANGE;
    }
    gsl_rng_free(generator);
    return random;
}

void quasi_random_destroy(struct quasi_random *random)
{
    if (random) gsl_qrng_free(random->sequence);
    free(random);
}

void quasi_random_next(struct quasi_random *random, double *point)
{
    gsl_qrng_get(random->sequence, point);
    for (int d = 0; d < random->dim; d++) {
        const uint32_t digits = (uint32_t)(point[d] * RANGE) ^ random->digits[d];
        const double part = (double)digits / RANGE + random->shift[d];
        point[d] = part < 1 ? part : part - 1;
    }
}
