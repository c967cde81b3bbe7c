/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gather.h"

#include "specialise.h"

#if SPHPROOF_CLONES && defined __x86_64__
#include <immintrin.h>
#endif

static void plain(const double *records, int size, const int32_t *slots, int count,
                  double *restrict out, ptrdiff_t stride)
{
    for (int k = 0; k < count; k++) {
        const double *record = records + (ptrdiff_t)slots[k] * size;
        for (int f = 0; f < size; f++) out[f * stride + k] = record[f];
    }
}

#if SPHPROOF_CLONES && defined __x86_64__

/* Records of up to this many groups have specialised loops with an unrolled inner loop. */
enum { GROUPS_MAX = 12 };

/* Four records at once, by transposing 4 x 4 blocks of values. */
__attribute__((target("avx2"), always_inline)) static inline void
squares(const double *records, int size, const int32_t *slots, int count, double *restrict out,
        ptrdiff_t stride)
{
    for (int k = 0; k < count; k += 4) {
        const double *r[4];
        for (int n = 0; n < 4; n++) r[n] = records + (ptrdiff_t)slots[k + n] * size;
        for (int f = 0; f < size; f += GATHER_GROUP) {
            const __m256d a = _mm256_load_pd(r[0] + f), b = _mm256_load_pd(r[1] + f),
                          c = _mm256_load_pd(r[2] + f), d = _mm256_load_pd(r[3] + f);
            const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b),
                          cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
            double *to = out + f * stride + k;
            _mm256_storeu_pd(to, _mm256_permute2f128_pd(ab_even, cd_even, 0x20));
            _mm256_storeu_pd(to + stride, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20));
            _mm256_storeu_pd(to + 2 * stride, _mm256_permute2f128_pd(ab_even, cd_even, 0x31));
            _mm256_storeu_pd(to + 3 * stride, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31));
        }
    }
}

/* Eight records at once: the two halves of a register hold records k and k + 4. */
__attribute__((target("avx512f"), always_inline)) static inline void
pairs_of_squares(const double *records, int size, const int32_t *slots, int count,
                 double *restrict out, ptrdiff_t stride)
{
    const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    for (int k = 0; k < count; k += 8) {
        const double *r[8];
        for (int n = 0; n < 8; n++) r[n] = records + (ptrdiff_t)slots[k + n] * size;
        for (int f = 0; f < size; f += GATHER_GROUP) {
            __m512d a[4];
            for (int n = 0; n < 4; n++)
                a[n] = _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(r[n] + f)),
                                          _mm256_load_pd(r[n + 4] + f), 1);
            const __m512d ab_even = _mm512_unpacklo_pd(a[0], a[1]),
                          ab_odd = _mm512_unpackhi_pd(a[0], a[1]),
                          cd_even = _mm512_unpacklo_pd(a[2], a[3]),
                          cd_odd = _mm512_unpackhi_pd(a[2], a[3]);
            double *to = out + f * stride + k;
            _mm512_storeu_pd(to, _mm512_permutex2var_pd(ab_even, low, cd_even));
            _mm512_storeu_pd(to + stride, _mm512_permutex2var_pd(ab_odd, low, cd_odd));
            _mm512_storeu_pd(to + 2 * stride, _mm512_permutex2var_pd(ab_even, high, cd_even));
            _mm512_storeu_pd(to + 3 * stride, _mm512_permutex2var_pd(ab_odd, high, cd_odd));
        }
    }
}

#define SPECIALISE(name, body, groups, set)                                                        \
    __attribute__((target(set))) static void name##_##groups(const double *records, int size,      \
                                                             const int32_t *slots, int count,      \
                                                             double *out, ptrdiff_t stride)        \
    {                                                                                              \
        (void)size;                                                                                \
        body(records, GATHER_GROUP *groups, slots, count, out, stride);                            \
    }
#define SPECIALISE_ALL(name, body, set)                                                            \
    SPECIALISE(name, body, 1, set)                                                                 \
    SPECIALISE(name, body, 2, set)                                                                 \
    SPECIALISE(name, body, 3, set)                                                                 \
    SPECIALISE(name, body, 4, set)                                                                 \
    SPECIALISE(name, body, 5, set)                                                                 \
    SPECIALISE(name, body, 6, set)                                                                 \
    SPECIALISE(name, body, 7, set)                                                                 \
    SPECIALISE(name, body, 8, set)                                                                 \
    SPECIALISE(name, body, 9, set)                                                                 \
    SPECIALISE(name, body, 10, set)                                                                \
    SPECIALISE(name, body, 11, set)                                                                \
    SPECIALISE(name, body, 12, set)                                                                \
    static gather_loop *const name[GROUPS_MAX + 1] = {                                             \
        plain,    name##_1, name##_2, name##_3,  name##_4,  name##_5, name##_6,                    \
        name##_7, name##_8, name##_9, name##_10, name##_11, name##_12};
SPECIALISE_ALL(avx2, squares, "avx2")
SPECIALISE_ALL(avx512, pairs_of_squares, "avx512f")

gather_loop *gather_choose(int size)
{
    const int groups = size / GATHER_GROUP;
    if (groups > GROUPS_MAX) return plain;
    return __builtin_cpu_supports("avx512f") ? avx512[groups]
           : __builtin_cpu_supports("avx2")  ? avx2[groups]
                                             : plain;
}

#else

gather_loop *gather_choose(int size)
{
    (void)size;
    return plain;
}

#endif
