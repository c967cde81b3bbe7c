/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lanes.h"

#ifdef _OPENMP
#include <omp.h>
#endif

static void add_groups(struct lanes_layout *layout, enum lanes_group first, int count)
{
    for (int g = 0; g < count; g++, layout->size += GATHER_GROUP)
        layout->offset[(int)first + g] = layout->size;
}

static void empty(struct lanes_layout *layout)
{
    layout->size = 0;
    for (int g = 0; g < GROUPS; g++) layout->offset[g] = -1;
}

/* Which values each pass needs of a neighbour. */
static void lay_out(struct cells *cells)
{
    const struct cells_method *method = &cells->method;
    const bool in_3d = method->box.dim == 3, matrix = method->gradient != GRADIENT_STANDARD;
    empty(&cells->density);
    add_groups(&cells->density, GROUP_PLACE, 1);
    if (method->energy_element) add_groups(&cells->density, GROUP_LAGRANGIAN, 1);
    empty(&cells->matrix);
    add_groups(&cells->matrix, GROUP_PLACE, 1);
    if (method->velocity_gradient) add_groups(&cells->matrix, GROUP_MOTION, 1);
    add_groups(&cells->matrix, GROUP_GAS, 1);
    struct lanes_layout *force = &cells->force;
    empty(force);
    add_groups(force, GROUP_PLACE, 1);
    add_groups(force, GROUP_MOTION, 1);
    add_groups(force, GROUP_GAS, 1);
    if (method->viscosity != VISCOSITY_NONE || method->conductivity > 0)
        add_groups(force, GROUP_VISCOSITY, 1);
    if (method->formulation == FORMULATION_LAGRANGIAN) add_groups(force, GROUP_LAGRANGIAN, 1);
    if (matrix) add_groups(force, GROUP_MATRIX, in_3d ? 2 : 1);
    if (method->viscosity == VISCOSITY_RECONSTRUCTED) add_groups(force, GROUP_SLOPE, in_3d ? 3 : 1);
    if (method->projected) add_groups(force, GROUP_PROJECTOR, in_3d ? 2 : 1);
}

static bool reserve_records(struct cells *cells, size_t n)
{
    if (n + 1 <= cells->capacity) return true;
    free(cells->records);
    int size = cells->force.size;
    if (cells->matrix.size > size) size = cells->matrix.size;
    cells->capacity = n + n / 4 + 8;
    cells->records =
        aligned_alloc(64, (cells->capacity * (size_t)size * sizeof(double) + 63) / 64 * 64);
    if (!cells->records) cells->capacity = 0;
    return cells->records != NULL;
}

struct cells *cells_create(const struct cells_method *method, size_t n)
{
    struct cells *cells = calloc(1, sizeof *cells);
    if (!cells) return NULL;
    cells->method = *method;
    cells->gather = gather_choose();
    cells->shapes = shapes_of(method->kernel, method->box.dim, method->stamped);
    lay_out(cells);
    cells->grid = grid_create(&method->box, n, method->threads);
    cells->lanes = calloc((size_t)method->threads, sizeof *cells->lanes);
    if (cells->grid && cells->lanes && reserve_records(cells, n)) return cells;
    cells_destroy(cells);
    return NULL;
}

void cells_destroy(struct cells *cells)
{
    if (!cells) return;
    for (int t = 0; cells->lanes && t < cells->method.threads; t++) free(cells->lanes[t].block);
    free(cells->lanes);
    free(cells->records);
    grid_destroy(cells->grid);
    free(cells);
}

const struct grid *cells_grid(const struct cells *cells)
{
    return cells->grid;
}

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

enum status cells_arrange(struct cells *cells, const struct cells_fields *fields,
                          const double *radius, struct error *error)
{
    const enum status status =
        grid_search(cells->grid, fields->n, fields->n, fields->x, radius, error);
    if (status) return status;
    if (!reserve_records(cells, fields->n) || !lanes_reserve(cells))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", fields->n);
    return STATUS_OK;
}

/* --- lanes ------------------------------------------------------------------------------------ */

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
