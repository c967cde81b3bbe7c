/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the stamped loops share. */
#ifndef SPHPROOF_LOOP_H
#define SPHPROOF_LOOP_H

#include "config.h"
#include "loops.h"

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* Feature names: names of architectures would silently run the default here. */
#if SPHPROOF_CLONES
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

/* The tables of the four files of sums; kernel: position in kernels.def, -1: unstamped. */
density_loop *loop_density(int kernel, enum density_terms terms);
matrix_loop *loop_matrix(int kernel, enum matrix_terms terms);
gradient_loop *loop_gradient(int kernel, enum gradient gradient, enum pair_gradient form);
force_loop *loop_force(bool stamped, enum formulation formulation, enum pair_viscosity viscosity,
                       enum energy energy);

/* Trip count in whole vectors: no remainder loop. What is computed beyond count goes into scratch
 * and is dropped. */
ALWAYS_INLINE int whole_vectors(int count)
{
    return (count + 7) & ~7;
}

ALWAYS_INLINE double largest(double a, double b)
{
    return a > b ? a : b;
}

ALWAYS_INLINE double least(double a, double b)
{
    return a < b ? a : b;
}

/* The largest of count = whole vectors of positive values, by lanes: clang does not vectorise
 * reduction(max). */
ALWAYS_INLINE double largest_of(const double *restrict values, ptrdiff_t count)
{
    double lane[8] = {0};
    for (ptrdiff_t i = 0; i < count; i += 8)
#pragma omp simd
        for (int l = 0; l < 8; l++) lane[l] = largest(lane[l], values[i + l]);
    for (int half = 4; half > 0; half /= 2)
        for (int l = 0; l < half; l++) lane[l] = largest(lane[l], lane[l + half]);
    return lane[0];
}

#endif
