/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tools for specialised loops: bodies that are always inlined with constant choices, dispatch over
 * instruction sets, and arithmetic that vectorises. */
#ifndef SPHPROOF_SPECIALISE_H
#define SPHPROOF_SPECIALISE_H

#include <stddef.h>

#include "config.h"

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* Names of features: with names of architectures the default would run here silently. */
#if SPHPROOF_CLONES
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

/* Rounds a trip count up to whole vectors, so that there is no remainder loop. Results beyond count
 * go to spare elements and are not used. */
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

/* Before the loop over the eight lanes of a sum: clang would unroll the loop before vectorising,
 * and then not vectorise. */
#ifdef __clang__
#define SIMD_LANES _Pragma("clang loop vectorize(enable) vectorize_width(8) unroll(disable)")
#else
#define SIMD_LANES _Pragma("omp simd")
#endif

/* Adds eight lanes in pairs: the same order for every instruction set. */
#define TREE(s) (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])))

/* The largest of count positive values, count a multiple of 8, by lanes: clang does not vectorise
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
