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
        /* half as much again, so that steps need not ask for more */
        lanes->stride = 8 * ((3 * stride / 16) | 1);
        lanes->block = aligned_alloc(64, (LANES_OWN + GROUPS * GATHER_GROUP) *
                                             (size_t)lanes->stride * sizeof(double));
        if (!lanes->block) return false;
    }
    return true;
}

/* What find_geometry works on; side 0: an open direction. */
struct geometry {
    double at[3], side[3];
    const double *x[3];
    double *d[3], *r, *r_inverse;
};

/* The difference that is nearest to 0: exactly odd, so that both sides of a pair agree. */
ALWAYS_INLINE double nearest(double d, double side)
{
    const double half = 0.5 * side;
    return d > half ? d - side : d < -half ? d + side : d;
}

/* 1/r is 0 where points coincide: a pair without a direction. */
ALWAYS_INLINE void geometry_body(int dim, bool wrapped, bool directed, int count,
                                 const struct geometry *g)
{
    const double x0 = g->at[0], y0 = g->at[1], z0 = g->at[2];
    const double side_x = g->side[0] > 0 ? g->side[0] : HUGE_VAL,
                 side_y = g->side[1] > 0 ? g->side[1] : HUGE_VAL,
                 side_z = g->side[2] > 0 ? g->side[2] : HUGE_VAL;
    const double *restrict x = g->x[0], *restrict y = g->x[1], *restrict z = g->x[2];
    double *restrict dx = g->d[0], *restrict dy = g->d[1], *restrict dz = g->d[2],
                     *restrict r = g->r, *restrict r_inverse = g->r_inverse;
#pragma omp simd
    for (int k = 0; k < count; k++) {
        double a = x[k] - x0, b = y[k] - y0, c = dim == 3 ? z[k] - z0 : 0;
        if (wrapped) {
            a = nearest(a, side_x);
            b = nearest(b, side_y);
            c = dim == 3 ? nearest(c, side_z) : 0;
        }
        const double r2 = dim == 3 ? a * a + b * b + c * c : a * a + b * b, root = sqrt(r2);
        r[k] = root;
        if (!directed) continue;
        dx[k] = a;
        dy[k] = b;
        dz[k] = c;
        r_inverse[k] = r2 > 0 ? 1 / root : 0;
    }
}

#define GEOMETRY(name, directed)                                                                   \
    CLONES static void name(int dim, bool wrapped, int count, const struct geometry *g)            \
    {                                                                                              \
        if (dim == 2 && wrapped)                                                                   \
            geometry_body(2, true, directed, count, g);                                            \
        else if (dim == 2)                                                                         \
            geometry_body(2, false, directed, count, g);                                           \
        else if (wrapped)                                                                          \
            geometry_body(3, true, directed, count, g);                                            \
        else                                                                                       \
            geometry_body(3, false, directed, count, g);                                           \
    }
GEOMETRY(find_geometry, true)
GEOMETRY(find_distances, false)
#undef GEOMETRY

static void gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                   int from, int count, const struct lanes *lanes)
{
    const struct grid_list *list = &grid_lists(cells->grid)[slot];
    const double *at = grid_positions(cells->grid)[slot];
    struct geometry g = {.r = lane(lanes, LANE_R), .r_inverse = lane(lanes, LANE_R_INVERSE)};
    for (int a = 0; a < 3; a++) {
        g.at[a] = at[a];
        g.side[a] = grid_side(cells->grid, a);
        g.x[a] = lane_of(lanes, layout, GROUP_PLACE, a);
        g.d[a] = lane(lanes, LANE_DX + a);
    }
    layout->gather(cells->records, layout->size, list->slots + from, count,
                   lanes->block + LANES_OWN * lanes->stride, lanes->stride);
    (layout == &cells->density ? find_distances : find_geometry)(cells->method.box.dim,
                                                                 list->wrapped, count, &g);
}

int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 const struct lanes *lanes)
{
    const int count = whole_vectors(grid_lists(cells->grid)[slot].count);
    gather(cells, layout, slot, 0, count, lanes);
    return count;
}

/* Bytes of lanes that the first-level cache holds beside records. */
enum { LANES_BYTES = 40 << 10 };

int lanes_gather_part(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                      int from, const struct lanes *lanes)
{
    const int most = LANES_BYTES / (int)sizeof(double) / (LANES_OWN + layout->size);
    const int whole = whole_vectors(grid_lists(cells->grid)[slot].count);
    const int parts = (whole + most - 1) / most;
    const int part = parts > 1 ? whole_vectors((whole + parts - 1) / parts) : whole;
    const int count = part < whole - from ? part : whole - from;
    gather(cells, layout, slot, from, count, lanes);
    return count;
}

void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass)
{
    const uint32_t *begin;
    const size_t parts = grid_parts(cells->grid, &begin);
#pragma omp parallel for num_threads(cells->team) schedule(dynamic) if (cells->team > 1)
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

CLONES static void scale_stamped(int count, const double *restrict r, double h_inverse,
                                 double *restrict q)
{
#pragma omp simd
    for (int k = 0; k < count; k++) q[k] = r[k] * h_inverse;
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

void lanes_scale(int count, const double *r, double h_inverse, double *q)
{
    scale_stamped(count, r, h_inverse, q);
}
