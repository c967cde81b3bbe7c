/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "lanes.h"

#include <math.h>
#include <stdlib.h>

#include "specialise.h"

int lanes_longest_record(const struct cells *cells)
{
    const struct lanes_layout *const layouts[] = {&cells->density, &cells->matrix, &cells->force,
                                                  &cells->shift};
    int size = 0;
    for (int k = 0; k < 4; k++) size = layouts[k]->size > size ? layouts[k]->size : size;
    return size;
}

bool lanes_reserve(struct cells *cells)
{
    /* an odd number of cache lines, so that arrays do not fall into the same cache sets */
    const ptrdiff_t stride = 8 * ((grid_longest(cells->grid) / 8 + 1) | 1);
    for (int t = 0; t < cells->method.threads; t++) {
        struct lanes *lanes = &cells->lanes[t];
        if (!grid_reader_reserve(cells->grid, &lanes->reader)) return false;
        if ((cells->parts || cells->halves) && lanes->capacity < 2 * (stride + 16)) {
            free(lanes->slots);
            lanes->capacity = 3 * (stride + 16);
            lanes->slots = malloc((size_t)lanes->capacity * sizeof *lanes->slots);
            if (!lanes->slots) return false;
        }
        if (lanes->block && stride <= lanes->stride) continue;
        free(lanes->block);
        /* half as much again, so that later steps need not reallocate */
        lanes->stride = 8 * ((3 * stride / 16) | 1);
        lanes->block = aligned_alloc(64, (size_t)(LANES_OWN + lanes_longest_record(cells)) *
                                             (size_t)lanes->stride * sizeof(double));
        if (!lanes->block) return false;
        for (ptrdiff_t k = 0; k < lanes->stride; k++) {
            lane(lanes, LANE_ONE)[k] = 1;
            lane(lanes, LANE_NUMBER)[k] = (double)k;
        }
    }
    return true;
}

/* Inputs and outputs of the geometry loops. */
struct geometry {
    const double *at, *side;     /* the particle's position; periods, HUGE_VAL: open */
    const double *x, *own_v, *v; /* axes are `stride` apart, in the results as well */
    double *d, *r, *r_inverse, *closing;
    ptrdiff_t stride;
};

/* Sets 1/r = 0 where points coincide, as such a pair has no direction. */
ALWAYS_INLINE void geometry_body(int dim, bool wrapped, enum lanes_geometry geometry, int count,
                                 const struct geometry *g)
{
    const bool moving = geometry == LANES_CLOSING;
    const ptrdiff_t y = g->stride, z = dim == 3 ? 2 * g->stride : 0;
    const double x0 = g->at[0], y0 = g->at[1], z0 = g->at[2];
    const double vx = moving ? g->own_v[0] : 0, vy = moving ? g->own_v[1] : 0,
                 vz = moving && dim == 3 ? g->own_v[2] : 0;
    const double side_x = g->side[0], side_y = g->side[1], side_z = g->side[2];
    const double *restrict x = g->x, *restrict v = g->v;
    double *restrict d = g->d, *restrict r = g->r, *restrict r_inverse = g->r_inverse,
                     *restrict closing = g->closing;
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        double a = x[k] - x0, b = x[y + k] - y0, c = dim == 3 ? x[z + k] - z0 : 0;
        if (wrapped) {
            a = grid_nearest(a, side_x);
            b = grid_nearest(b, side_y);
            c = dim == 3 ? grid_nearest(c, side_z) : 0;
        }
        const double r2 = dim == 3 ? a * a + b * b + c * c : a * a + b * b, root = sqrt(r2);
        r[k] = root;
        if (geometry == LANES_DISTANCE) continue;
        d[k] = a;
        d[y + k] = b;
        if (dim == 3) d[z + k] = c;
        if (geometry == LANES_DISPLACEMENT) continue;
        const double inverse = r2 > 0 ? 1 / root : 0;
        r_inverse[k] = inverse;
        if (!moving) continue;
        const double plane = (vx - v[k]) * a + (vy - v[y + k]) * b;
        closing[k] = (dim == 3 ? plane + (vz - v[z + k]) * c : plane) * inverse;
    }
}

#define GEOMETRY(name, wanted)                                                                     \
    CLONES static void name(int dim, bool wrapped, int count, const struct geometry *g)            \
    {                                                                                              \
        if (dim == 2 && wrapped)                                                                   \
            geometry_body(2, true, wanted, count, g);                                              \
        else if (dim == 2)                                                                         \
            geometry_body(2, false, wanted, count, g);                                             \
        else if (wrapped)                                                                          \
            geometry_body(3, true, wanted, count, g);                                              \
        else                                                                                       \
            geometry_body(3, false, wanted, count, g);                                             \
    }
GEOMETRY(find_distances, LANES_DISTANCE)
GEOMETRY(find_displacements, LANES_DISPLACEMENT)
GEOMETRY(find_directions, LANES_DIRECTION)
GEOMETRY(find_closing, LANES_CLOSING)
#undef GEOMETRY

static void gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                   const int32_t *slots, int count, struct lanes *lanes)
{
    const bool wrapped = cells->lists[slot].wrapped;
    const int dim = cells->method.box.dim;
    struct geometry g = {.at = cells->position[slot],
                         .side = cells->side,
                         .x = lane_of(lanes, layout, RECORD_POSITION),
                         .d = lane(lanes, LANE_DX),
                         .r = lane(lanes, LANE_R),
                         .r_inverse = lane(lanes, LANE_R_INVERSE),
                         .closing = lane(lanes, LANE_CLOSING),
                         .stride = lanes->stride};
    layout->gather(cells->records, layout->size, slots, count, lane(lanes, LANES_OWN),
                   lanes->stride);
    switch (layout->geometry) {
    case LANES_DISTANCE:
        find_distances(dim, wrapped, count, &g);
        break;
    case LANES_DISPLACEMENT:
        find_displacements(dim, wrapped, count, &g);
        break;
    case LANES_DIRECTION:
        find_directions(dim, wrapped, count, &g);
        break;
    case LANES_CLOSING:
        g.v = lane_of(lanes, layout, RECORD_VELOCITY);
        g.own_v = cells->records + (ptrdiff_t)slot * layout->size + layout->offset[RECORD_VELOCITY];
        find_closing(dim, wrapped, count, &g);
        break;
    }
}

int lanes_gather(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                 struct lanes *lanes)
{
    const int count = whole_vectors(cells->lists[slot].count);
    gather(cells, layout, slot, grid_neighbours(cells->grid, &lanes->reader, cells->lists, slot),
           count, lanes);
    return count;
}

struct lanes_list lanes_partners(const struct cells *cells, size_t slot, struct lanes *lanes)
{
    const int32_t *slots = grid_neighbours(cells->grid, &lanes->reader, cells->lists, slot);
    const int32_t count = cells->lists[slot].count;
    if (lanes->chunk.of) return reactions_partners(cells, slot, slots, count, lanes);
    if (!cells->parts) return (struct lanes_list){slots, count, 0};
    const unsigned char *kinds = cells->kinds;
    const bool active = kinds[slot] == CELLS_ACTIVE;
    int kept = 0;
    if (cells->pair_level >= 0) /* keep the pairs that move from this level to a finer one */
        for (int32_t k = 0; k < count; k++) {
            const unsigned own = kinds[slot], others = kinds[slots[k]];
            const unsigned before = (own & 15) > (others & 15) ? own & 15 : others & 15,
                           after = own >> 4 > others >> 4 ? own >> 4 : others >> 4;
            lanes->slots[kept] = slots[k];
            kept += before == (unsigned)cells->pair_level && after > before;
        }
    else /* active particles interact with all but finer levels, others with active ones */
        for (int32_t k = 0; k < count; k++) {
            const unsigned char kind = kinds[slots[k]];
            lanes->slots[kept] = slots[k];
            kept += active ? kind != CELLS_SUMMED : kind == CELLS_ACTIVE;
        }
    for (int k = kept; k < whole_vectors(kept); k++) lanes->slots[k] = (int32_t)cells->points;
    return (struct lanes_list){lanes->slots, kept, 0};
}

/* Bytes of lanes that fit into the first-level cache beside the records. */
enum { LANES_BYTES = 24 << 10 };

int lanes_gather_part(const struct cells *cells, const struct lanes_layout *layout, size_t slot,
                      const struct lanes_list *list, int from, struct lanes *lanes)
{
    const int most = LANES_BYTES / (int)sizeof(double) / (LANES_OWN + layout->size);
    const int whole = whole_vectors(list->count);
    const int parts = (whole + most - 1) / most;
    const int part = parts > 1 ? whole_vectors((whole + parts - 1) / parts) : whole;
    const int count = part < whole - from ? part : whole - from;
    gather(cells, layout, slot, list->slots + from, count, lanes);
    return count;
}

void lanes_all(struct cells *cells, const struct cells_fields *fields, lanes_pass *pass)
{
    const uint32_t *begin;
    struct team_shares shares;
    team_share(&shares, cells->team, grid_parts(cells->grid, &begin));
#pragma omp parallel num_threads(cells->team) if (cells->team > 1)
    for (size_t p; team_next(&shares, &p);) {
        struct lanes *lanes = &cells->lanes[team_thread()];
        for (size_t slot = begin[p]; slot < begin[p + 1]; slot++)
            if (cells->lists[slot].kept) pass(cells, fields, slot, lanes);
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

CLONES static bool agree(int axes, int count, ptrdiff_t stride, const double *restrict own,
                         const double *restrict others, double limit)
{
    int k = 0;
    for (; k + GRID_LANES <= count; k += GRID_LANES)
        for (int a = 0; a < axes; a++) {
            const double *restrict values = others + a * stride + k;
            double apart = 0;
#pragma omp simd reduction(+ : apart)
            for (int l = 0; l < GRID_LANES; l++)
                apart += fabs(values[l] - own[a]) <= limit ? 0. : 1.;
            if (apart > 0) return false;
        }
    for (; k < count; k++)
        for (int a = 0; a < axes; a++)
            if (!(fabs(others[a * stride + k] - own[a]) <= limit)) return false;
    return true;
}

/* CLONES functions are static, and public functions call them: clang 14 renames the dispatched
 * symbol, so that other files would not find it. */
double lanes_sum(const double *values, int count)
{
    return sum(values, count);
}

double lanes_dot(const double *a, const double *b, int count)
{
    return dot(a, b, count);
}

bool lanes_agree(int axes, int count, ptrdiff_t stride, const double *own, const double *others,
                 double limit)
{
    return agree(axes, count, stride, own, others, limit);
}
