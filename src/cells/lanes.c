/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lanes.h"

#include <math.h>
#include <stdlib.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#include "stamp.h"

bool lanes_reserve(struct cells *cells)
{
    /* an odd number of cache lines, so that arrays do not fall on the same cache sets */
    const ptrdiff_t stride = 8 * ((grid_longest(cells->grid) / 8 + 1) | 1);
    for (int t = 0; t < cells->method.threads; t++) {
        struct lanes *lanes = &cells->lanes[t];
        if (lanes->block && stride <= lanes->stride) continue;
        free(lanes->block);
        lanes->stride = lanes->block ? 8 * ((2 * stride / 8) | 1) : stride;
        lanes->block = aligned_alloc(64, (LANES_OWN + GROUPS * GATHER_GROUP) *
                                             (size_t)lanes->stride * sizeof(double));
        if (!lanes->block) return false;
    }
    return true;
}

CLONES static void difference(int count, double at, double side, bool wrapped,
                              const double *restrict x, double *restrict d)
{
    const double half = 0.5 * side;
    if (wrapped && side > 0) {
#pragma omp simd
        for (int k = 0; k < count; k++) {
            const double plain = x[k] - at;
            d[k] = plain > half ? plain - side : plain < -half ? plain + side : plain;
        }
    } else {
#pragma omp simd
        for (int k = 0; k < count; k++) d[k] = x[k] - at;
    }
}

/* 1/r is 0 where points coincide: a pair without a direction. */
CLONES static void distance(int count, const double *restrict dx, const double *restrict dy,
                            const double *restrict dz, double *restrict r,
                            double *restrict r_inverse)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double r2 = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
        r[k] = sqrt(r2);
        r_inverse[k] = r2 > 0 ? 1 / r[k] : 0;
    }
}

int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 const struct lanes *lanes)
{
    const struct grid_list *list = &grid_lists(cells->grid)[slot];
    const int count = whole_vectors(list->count);
    cells->gather(cells->records, layout->size, list->slots, count,
                  lanes->block + LANES_OWN * lanes->stride, lanes->stride);
    const double *at = grid_positions(cells->grid)[slot];
    for (int a = 0; a < 3; a++)
        difference(count, at[a], grid_side(cells->grid, a), list->wrapped,
                   lane_of(lanes, layout, GROUP_PLACE, a), lane(lanes, LANE_DX + a));
    distance(count, lane(lanes, LANE_DX), lane(lanes, LANE_DY), lane(lanes, LANE_DZ),
             lane(lanes, LANE_R), lane(lanes, LANE_R_INVERSE));
    return count;
}

void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass)
{
    const uint32_t *begin;
    const size_t parts = grid_parts(cells->grid, &begin);
#pragma omp parallel for num_threads(cells->method.threads)                                        \
    schedule(dynamic) if (cells->method.threads > 1)
    for (size_t p = 0; p < parts; p++) {
#ifdef _OPENMP
        struct lanes *lanes = &cells->lanes[omp_get_thread_num()];
#else
        struct lanes *lanes = &cells->lanes[0];
#endif
        for (size_t slot = begin[p]; slot < begin[p + 1]; slot++)
            if (grid_lists(cells->grid)[slot].slots) pass(cells, fields, slot, lanes);
    }
}

/* Eight lanes, then in pairs: the same order for every instruction set. */
#define TREE(s) (((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7])))

CLONES static double sum(const double *restrict values, int count)
{
    double s[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) s[l] += values[k + l];
    return TREE(s);
}

CLONES static double dot(const double *restrict a, const double *restrict b, int count)
{
    double s[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) s[l] += a[k + l] * b[k + l];
    return TREE(s);
}

/* Stamped functions are static, and the public ones call them: clang 14 gives the dispatched symbol
 * a name of its own, so that another file would not find it. */
double lanes_sum(const double *values, int count)
{
    return sum(values, count);
}

double lanes_dot(const double *a, const double *b, int count)
{
    return dot(a, b, count);
}
