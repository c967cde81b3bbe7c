/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lanes.h"

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
    cells->shapes = shapes_of(method->kernel, method->box.dim, method->stamped);
    lay_out(cells);
    struct lanes_layout *const layouts[] = {&cells->density, &cells->matrix, &cells->force};
    for (int k = 0; k < 3; k++) layouts[k]->gather = gather_choose(layouts[k]->size);
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
