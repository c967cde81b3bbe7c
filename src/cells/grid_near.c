/* SPDX-License-Identifier: GPL-3.0-or-later
 * The distance loops over candidates: plain ones, and equivalent ones for processors with AVX-512.
 */
#include <math.h>
#include <string.h>

#include "grid_inside.h"
#include "specialise.h"

#if SPHPROOF_CLONES && defined __x86_64__
#include <immintrin.h>
#endif

/* The distance along a periodic axis between points that are d apart, |d| < 1.5 side. */
ALWAYS_INLINE float around_axis(float d, float side)
{
    const float one_way = fabsf(d), other_way = fabsf(side - one_way);
    return one_way < other_way ? one_way : other_way;
}

/* candidates->near[k] = 1 if candidate k is near the point at `at`, otherwise 0; count: a multiple
 * of 16. images: the nearest image of each candidate counts. */
ALWAYS_INLINE void near_body(int dim, bool images, const struct candidates *candidates,
                             size_t count, const float at[3], float radius2, const float side[3])
{
    const float *restrict x = candidates->x[0], *restrict y = candidates->x[1],
                          *restrict z = candidates->x[2], *restrict other = candidates->radius2;
    uint8_t *restrict near = candidates->near;
    const float x0 = at[0], y0 = at[1], z0 = at[2], sx = images ? side[0] : 0,
                sy = images ? side[1] : 0, sz = images ? side[2] : 0;
#pragma omp simd
    for (size_t k = 0; k < count; k++) {
        float dx = x[k] - x0, dy = y[k] - y0, dz = dim == 3 ? z[k] - z0 : 0;
        if (images) {
            dx = around_axis(dx, sx);
            dy = around_axis(dy, sy);
            dz = dim == 3 ? around_axis(dz, sz) : 0;
        }
        const float r2 = dim == 3 ? dx * dx + dy * dy + dz * dz : dx * dx + dy * dy;
        const float most = other[k] > radius2 ? other[k] : radius2;
        near[k] = r2 < most;
    }
}

CLONES static void find_near(int dim, const struct candidates *candidates, size_t count,
                             const float at[3], float radius2, const float *side)
{
    if (dim == 2 && side)
        near_body(2, true, candidates, count, at, radius2, side);
    else if (dim == 2)
        near_body(2, false, candidates, count, at, radius2, side);
    else if (side)
        near_body(3, true, candidates, count, at, radius2, side);
    else
        near_body(3, false, candidates, count, at, radius2, side);
}

/* Packs bytes of 0 and 1 into bits. Returns the number of ones. */
static int32_t pack(const uint8_t *near, size_t count, uint16_t *marks)
{
    const uint64_t to_top = 0x0102040810204080u, sum = 0x0101010101010101u;
    uint64_t found = 0;
    for (size_t k = 0; k < count; k += 16) {
        uint64_t half[2];
        memcpy(half, near + k, sizeof half);
        const uint64_t low = half[0] * to_top >> 56, high = half[1] * to_top >> 56;
        marks[k / 16] = (uint16_t)(low | high << 8);
        found += (half[0] + half[1]) * sum >> 56;
    }
    return (int32_t)found;
}

/* Writes the marks of 16 points from number `at` on; keeps the marks before it. */
ALWAYS_INLINE void put_marks(uint16_t *marks, size_t at, uint32_t near)
{
    const uint32_t before = marks[at / 16] & ((1u << at % 16) - 1), wide = near << at % 16 | before;
    marks[at / 16] = (uint16_t)wide;
    marks[at / 16 + 1] = (uint16_t)(wide >> 16);
}

/* Distance from x to the interval lo .. hi, or to its nearest image. */
ALWAYS_INLINE float outside(float x, float lo, float hi, float side)
{
    const float above = x - hi, below = lo - x, one_way = above > below ? above : below;
    const float farthest = above < below ? -above : -below, other_way = side - farthest;
    const float d = one_way < other_way ? one_way : other_way;
    return d > 0 ? d : 0;
}

/* Rounding is monotonic: the distance to a point inside the box never rounds to less than the
 * distance to the box. */
CLONES static size_t take_plainly(const struct grid *grid, size_t cell, const float moved[3],
                                  const struct surroundings *around, struct candidates *to,
                                  size_t count, size_t at)
{
    const size_t first = grid->start[cell], all = grid->start[cell + 1] - first;
    const float moved_x = moved[0], moved_y = moved[1], moved_z = moved[2],
                radius2 = around->radius2;
    const float x0 = around->lo[0], y0 = around->lo[1], z0 = around->lo[2], x1 = around->hi[0],
                y1 = around->hi[1], z1 = around->hi[2], side_x = around->side[0],
                side_y = around->side[1], side_z = around->side[2];
    for (size_t begin = 0; begin < all; begin += COPIED) {
        const size_t n = all - begin < COPIED ? all - begin : COPIED;
        const size_t from = first + begin;
        const float *restrict x = grid->in_cell[0] + from, *restrict y = grid->in_cell[1] + from,
                              *restrict z = grid->in_cell[2] + from,
                              *restrict others = grid->radius2 + from;
        float at_x[COPIED], at_y[COPIED], at_z[COPIED];
        uint8_t near[COPIED];
#pragma omp simd
        for (int k = 0; k < COPIED; k++) {
            at_x[k] = x[k] + moved_x;
            at_y[k] = y[k] + moved_y;
            at_z[k] = z[k] + moved_z;
            const float dx = outside(at_x[k], x0, x1, side_x),
                        dy = outside(at_y[k], y0, y1, side_y),
                        dz = outside(at_z[k], z0, z1, side_z);
            const float r2 = dx * dx + dy * dy + dz * dz;
            const float widest = others[k] > radius2 ? others[k] : radius2;
            near[k] = r2 <= widest;
        }
        uint16_t marks;
        pack(near, COPIED, &marks);
        if (n < COPIED) marks &= (uint16_t)((1u << n) - 1);
        for (uint32_t left = marks; left; left &= left - 1, count++) {
            const int k = __builtin_ctz(left);
            to->x[0][count] = at_x[k];
            to->x[1][count] = at_y[k];
            to->x[2][count] = at_z[k];
            to->radius2[count] = others[k];
        }
        put_marks(to->marks, at + begin, marks);
    }
    return count;
}

static int32_t find_plainly(int dim, const struct candidates *candidates, size_t count,
                            const float at[3], float radius2, const float *side, uint16_t *marks)
{
    find_near(dim, candidates, count, at, radius2, side);
    return pack(candidates->near, count, marks);
}

/* 64 marks at once, because the end of each inner loop is expensive. */
static int32_t read_plainly(const int32_t *candidates, const uint16_t *marks, size_t count,
                            int32_t *list)
{
    int32_t found = 0;
    for (size_t k = 0; k < count; k += 64) {
        uint64_t left = 0;
        for (size_t m = k; m < k + 64 && m < count; m += 16)
            left |= (uint64_t)marks[m / 16] << (m - k);
        for (; left; left &= left - 1)
            list[found++] = candidates[k + (size_t)__builtin_ctzll(left)];
    }
    return found;
}

#if SPHPROOF_CLONES && defined __x86_64__

/* The difference of a coordinate from that of 16 candidates, or the distance to their nearest
 * images. */
__attribute__((target("avx512f"), always_inline)) static inline __m512
differ_in_vectors(bool images, const float *x, float x0, float side)
{
    const __m512 d = _mm512_sub_ps(_mm512_loadu_ps(x), _mm512_set1_ps(x0));
    if (!images) return d;
    const __m512 one_way = _mm512_abs_ps(d);
    return _mm512_min_ps(one_way, _mm512_abs_ps(_mm512_sub_ps(_mm512_set1_ps(side), one_way)));
}

__attribute__((target("avx512f,popcnt"), always_inline)) static inline int32_t
find_body(int dim, bool images, const struct candidates *candidates, size_t count,
          const float at[3], float radius2, const float *side, uint16_t *marks)
{
    const __m512 own = _mm512_set1_ps(radius2);
    int32_t found = 0;
    for (size_t k = 0; k < count; k += 16) {
        __m512 r2 = _mm512_setzero_ps();
        for (int a = 0; a < dim; a++) {
            const __m512 d =
                differ_in_vectors(images, candidates->x[a] + k, at[a], images ? side[a] : 0);
            r2 = _mm512_add_ps(r2, _mm512_mul_ps(d, d));
        }
        const __m512 most = _mm512_max_ps(_mm512_loadu_ps(candidates->radius2 + k), own);
        const __mmask16 near = _mm512_cmp_ps_mask(r2, most, _CMP_LT_OQ);
        marks[k / 16] = near;
        found += _mm_popcnt_u32(near);
    }
    return found;
}

__attribute__((target("avx512f,popcnt"))) static int32_t
find_in_vectors(int dim, const struct candidates *candidates, size_t count, const float at[3],
                float radius2, const float *side, uint16_t *marks)
{
    if (dim == 2 && side) return find_body(2, true, candidates, count, at, radius2, side, marks);
    if (dim == 2) return find_body(2, false, candidates, count, at, radius2, side, marks);
    if (side) return find_body(3, true, candidates, count, at, radius2, side, marks);
    return find_body(3, false, candidates, count, at, radius2, side, marks);
}

/* As take_plainly; a compress instruction packs the lanes that are kept. */
__attribute__((target("avx512f,popcnt"))) static size_t
take_in_vectors(const struct grid *grid, size_t cell, const float moved[3],
                const struct surroundings *around, struct candidates *to, size_t count, size_t at)
{
    const size_t first = grid->start[cell], all = grid->start[cell + 1] - first;
    const __m512 none = _mm512_setzero_ps(), own = _mm512_set1_ps(around->radius2);
    for (size_t begin = 0; begin < all; begin += COPIED) {
        const size_t n = all - begin;
        const __mmask16 there = (__mmask16)(n < COPIED ? (1u << n) - 1 : 0xffffu);
        __m512 x[3], r2 = none;
        for (int a = 0; a < 3; a++) {
            x[a] = _mm512_add_ps(_mm512_loadu_ps(grid->in_cell[a] + first + begin),
                                 _mm512_set1_ps(moved[a]));
            const __m512 above = _mm512_sub_ps(x[a], _mm512_set1_ps(around->hi[a])),
                         below = _mm512_sub_ps(_mm512_set1_ps(around->lo[a]), x[a]);
            __m512 d = _mm512_max_ps(above, below);
            if (around->images) {
                const __m512 nearest = _mm512_min_ps(above, below); /* minus the farthest end */
                d = _mm512_min_ps(d, _mm512_add_ps(_mm512_set1_ps(around->side[a]), nearest));
            }
            d = _mm512_max_ps(d, none);
            r2 = _mm512_add_ps(r2, _mm512_mul_ps(d, d));
        }
        const __m512 others = _mm512_loadu_ps(grid->radius2 + first + begin);
        const __mmask16 near =
            _mm512_mask_cmp_ps_mask(there, r2, _mm512_max_ps(others, own), _CMP_LE_OQ);
        for (int a = 0; a < 3; a++)
            _mm512_storeu_ps(to->x[a] + count, _mm512_maskz_compress_ps(near, x[a]));
        _mm512_storeu_ps(to->radius2 + count, _mm512_maskz_compress_ps(near, others));
        put_marks(to->marks, at + begin, near);
        count += (size_t)_mm_popcnt_u32(near);
    }
    return count;
}

/* As read_plainly. */
__attribute__((target("avx512f,popcnt"))) static int32_t
read_by_compressing(const int32_t *candidates, const uint16_t *marks, size_t count, int32_t *list)
{
    int32_t found = 0;
    for (size_t k = 0; k < count; k += 16) {
        const __mmask16 near = marks[k / 16];
        const __m512i slot = _mm512_loadu_si512(candidates + k);
        _mm512_storeu_si512(list + found, _mm512_maskz_compress_epi32(near, slot));
        found += _mm_popcnt_u32(near);
    }
    return found;
}

take_loop *grid_take_choose(void)
{
    return __builtin_cpu_supports("avx512f") ? take_in_vectors : take_plainly;
}

find_loop *grid_find_choose(void)
{
    return __builtin_cpu_supports("avx512f") ? find_in_vectors : find_plainly;
}

read_loop *grid_read_choose(void)
{
    return __builtin_cpu_supports("avx512f") ? read_by_compressing : read_plainly;
}

#else

take_loop *grid_take_choose(void)
{
    return take_plainly;
}

find_loop *grid_find_choose(void)
{
    return find_plainly;
}

read_loop *grid_read_choose(void)
{
    return read_plainly;
}

#endif
