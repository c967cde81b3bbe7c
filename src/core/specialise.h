/* SPDX-License-Identifier: GPL-3.0-or-later
 * What every specialised loop is made of: bodies that are always inlined with their choices as
 * constants, the dispatch over instruction sets, and arithmetic that vectorises. */
#ifndef SPHPROOF_SPECIALISE_H
#define SPHPROOF_SPECIALISE_H

#include <stddef.h>

#include "config.h"

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* Feature names: names of architectures would silently run the default here. */
#if SPHPROOF_CLONES
#define CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define CLONES
#endif

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

/* Before the loop over the eight lanes of sums: clang unrolls it before it looks for vectors, and
 * then finds none. */
#ifdef __clang__
#define SIMD_LANES _Pragma("clang loop vectorize(enable) vectorize_width(8) unroll(disable)")
#else
#define SIMD_LANES _Pragma("omp simd")
#endif

/* Eight lanes, then in pairs: the same order for every instruction set. */
#define TREE(s) (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])))

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
