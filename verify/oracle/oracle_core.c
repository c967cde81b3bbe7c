/* SPDX-License-Identifier: GPL-3.0-or-later
 * Geometry and kernels of the oracle. */
#include <math.h>

#include "oracle_parts.h"

long double oracle_dot(const oracle_vector a, const oracle_vector b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void oracle_product(const struct oracle_matrix *A, const oracle_vector x, oracle_vector Ax)
{
    for (int a = 0; a < 3; a++) Ax[a] = oracle_dot(A->row[a], x);
}

int oracle_images(const struct oracle *oracle)
{
    return oracle->dim == 1 ? 1 : 0;
}

long double oracle_separation(const struct oracle *oracle, const struct oracle_particle *i,
                              const struct oracle_particle *j, int image, oracle_vector x)
{
    for (int k = 0; k < 3; k++) {
        x[k] = j->x[k] - i->x[k];
        if (k < oracle->dim) x[k] -= oracle->period[k] * roundl(x[k] / oracle->period[k]);
    }
    x[0] += image * oracle->period[0];
    return sqrtl(oracle_dot(x, x));
}

static long double *distance_at(const struct oracle *oracle, size_t i, size_t j, int image)
{
    return &oracle->distance[3 * (i * oracle->n + j) + (size_t)(image + 1)];
}

long double oracle_distance(const struct oracle *oracle, size_t i, size_t j, int image)
{
    return *distance_at(oracle, i, j, image);
}

void oracle_find_distances(struct oracle *oracle)
{
    oracle_vector x;
    for (size_t i = 0; i < oracle->n; i++)
        for (size_t j = 0; j < oracle->n; j++)
            for (int k = -oracle_images(oracle); k <= oracle_images(oracle); k++)
                *distance_at(oracle, i, j, k) =
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

long double oracle_dW_dh(const struct oracle *oracle, long double r, long double h)
{
    return -(oracle->dim * oracle_W(oracle, r, h) + r * oracle_dW_dr(oracle, r, h)) / h;
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
