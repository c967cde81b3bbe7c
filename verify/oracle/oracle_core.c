/* SPDX-License-Identifier: GPL-3.0-or-later
 * Geometry and kernels of the oracle. */
#include <math.h>

#include "oracle_parts.h"

void oracle_find_distances(struct oracle *oracle)
{
    oracle_vector x;
    for (size_t i = 0; i < oracle->n; i++)
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++)
                *oracle_distance_at(oracle, i, j, k) =
                    oracle_separation(oracle, &oracle->particles[i], &oracle->particles[j], k, x);
}

long double oracle_W(const struct oracle *oracle, long double r, long double h)
{
    return oracle->kernel.constant / oracle_power(h, oracle->dim) *
           oracle_kernel_w(&oracle->kernel, r / h);
}

long double oracle_dW_dr(const struct oracle *oracle, long double r, long double h)
{
    return oracle->kernel.constant / oracle_power(h, oracle->dim + 1) *
           oracle_kernel_dw(&oracle->kernel, r / h);
}

long double oracle_Z(const struct oracle *oracle, const struct oracle_particle *a)
{
    switch (oracle->scheme.volume_element) {
    case VOLUME_ENERGY:
        return a->U;
    case VOLUME_NUMBER:
        return 1;
    default:
        return a->m;
    }
}
