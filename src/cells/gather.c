/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gather.h"

#include "stamp.h"

static void plain(const double *records, int size, const int32_t *slots, int count,
                  double *restrict out, ptrdiff_t stride)
{
    for (int k = 0; k < count; k++) {
        const double *record = records + (ptrdiff_t)slots[k] * size;
        for (int f = 0; f < size; f++) out[f * stride + k] = record[f];
    }
}

#if SPHPROOF_CLONES && (defined __x86_64__)

typedef double vector __attribute__((vector_size(32)));

/* Four records at once, by transposing squares of four values. */
__attribute__((target("avx2"))) static void squares(const double *records, int size,
                                                    const int32_t *slots, int count,
                                                    double *restrict out, ptrdiff_t stride)
{
    for (int k = 0; k < count; k += 4) {
        const double *r0 = records + (ptrdiff_t)slots[k] * size,
                     *r1 = records + (ptrdiff_t)slots[k + 1] * size,
                     *r2 = records + (ptrdiff_t)slots[k + 2] * size,
                     *r3 = records + (ptrdiff_t)slots[k + 3] * size;
        for (int f = 0; f < size; f += GATHER_GROUP) {
            const vector a = *(const vector *)(const void *)(r0 + f),
                         b = *(const vector *)(const void *)(r1 + f),
                         c = *(const vector *)(const void *)(r2 + f),
                         d = *(const vector *)(const void *)(r3 + f);
            const vector ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                         ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                         cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                         cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
            double *to = out + f * stride + k;
            *(vector *)(void *)to = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
            *(vector *)(void *)(to + stride) =
                __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
            *(vector *)(void *)(to + 2 * stride) =
                __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
            *(vector *)(void *)(to + 3 * stride) =
                __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
        }
    }
}

gather_loop *gather_choose(void)
{
    return __builtin_cpu_supports("avx2") ? squares : plain;
}

#else

gather_loop *gather_choose(void)
{
    return plain;
}

#endif
