/* SPDX-License-Identifier: GPL-3.0-or-later
 * Internal to the oracle: geometry and kernels, the state of each particle, the terms of each
 * pair. */
#pragma once

#include <math.h>

#include "oracle.h"

/* Functions that every pair calls are here to be inlined: they take a third of the oracle's
 * time. */
static inline long double oracle_dot(const oracle_vector a, const oracle_vector b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void oracle_product(const struct oracle_matrix *A, const oracle_vector x,
                                  oracle_vector Ax)
{
    for (int a = 0; a < 3; a++) Ax[a] = oracle_dot(A->row[a], x);
}

/* In 1D h may exceed half of the box: the images -1, 0, 1 about the nearest one count. */
static inline int oracle_images(const struct oracle *oracle)
{
    return oracle->dim == 1 ? 1 : 0;
}

/* x = r_j - r_i of an image about the nearest one; returns its length. */
static inline long double oracle_separation(const struct oracle *oracle,
                                            const struct oracle_particle *i,
                                            const struct oracle_particle *j, int image,
                                            oracle_vector x)
{
    for (int k = 0; k < 3; k++) {
        x[k] = j->x[k] - i->x[k];
        if (2 * fabsl(x[k]) >= oracle->period[k] && k < oracle->dim)
            x[k] -= oracle->period[k] * roundl(x[k] / oracle->period[k]);
    }
    x[0] += image * oracle->period[0];
    return sqrtl(oracle_dot(x, x));
}

/* The same length for particles i and j, which oracle_find_distances computed at the start of the
 * evaluation. */
void oracle_find_distances(struct oracle *oracle);
static inline long double *oracle_distance_at(const struct oracle *oracle, size_t i, size_t j,
                                              int image)
{
    return &oracle->distance[3 * (i * oracle->n + j) + (size_t)(image + 1)];
}

static inline long double oracle_distance(const struct oracle *oracle, size_t i, size_t j,
                                          int image)
{
    return *oracle_distance_at(oracle, i, j, image);
}

/* W and dW/dr at a distance r. */
long double oracle_W(const struct oracle *oracle, long double r, long double h);
long double oracle_dW_dr(const struct oracle *oracle, long double r, long double h);

/* The quantity in the density sum: m, 1 or U. */
long double oracle_Z(const struct oracle *oracle, const struct oracle_particle *a);

/* The weight of a gradient by matrix, in the matrix and in the pair vector. */
long double oracle_weight(const struct oracle *oracle, long double r, long double h);

/* Moments, velocity gradients and what follows from them, for all particles. */
void oracle_find_matrices(struct oracle *oracle);

/* The switch of viscosity=cullen_dehnen, from the rates of all particles; and the change of alpha
 * by it in a step. */
void oracle_find_switch(struct oracle *oracle);
void oracle_apply_switch(struct oracle *oracle, long double dt);

/* Adds the contributions of pair (a, b) to the rates of a; x = r_b - r_a. */
void oracle_add_pair(const struct oracle *oracle, struct oracle_particle *a,
                     const struct oracle_particle *b, const oracle_vector x);
