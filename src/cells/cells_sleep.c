/* SPDX-License-Identifier: GPL-3.0-or-later
 * Decides which particles wake and which fall asleep in 2D and 3D, pair by pair, from the
 * disturbances of the awake particles. */
#include <math.h>
#include <string.h>

#include "cells.h"
#include "lanes.h"

static const int32_t *list_of(struct cells *cells, size_t slot, struct lanes *lanes)
{
    return grid_neighbours(cells->grid, &lanes->reader, cells->lists, slot);
}

/* Squared relative speed of particle i and neighbour j (mirrored: see lanes_source). */
static double passing2(const struct cells *cells, const struct cells_fields *fields, size_t i,
                       size_t j, int mirrored)
{
    double square = 0;
    for (int k = 0; k < cells->method.box.dim; k++) {
        const double d = fields->v[k][i] - lanes_sign(mirrored, k) * fields->v[k][j];
        square += d * d;
    }
    return square;
}

static double square_of_limit(const struct cells_fields *fields, const struct cells_quiet *quiet,
                              size_t i)
{
    const double c = fields->c[i] > quiet->sound ? fields->c[i] : quiet->sound;
    return quiet->tolerance * c * quiet->tolerance * c;
}

/* Largest part of a disturbance that passes through a neighbour within one step, through its
 * density and then its force. In a box with an open side it is a hundred times as large, because
 * gas below a free surface is not in equilibrium as far as matrices reach. */
static double carried(const struct cells *cells)
{
    const struct cells_method *method = &cells->method;
    bool open = false;
    for (int k = 0; k < method->box.dim; k++)
        open = open || !(method->box.periodic[k] || method->wall[k]);
    return open ? 1e-3 : 1e-5;
}

/* Upper bound of the disturbance that arrives from a neighbour, in units of the pressure term. */
static const double terms = 4;

/* The disturbance that the neighbours of the particle at a slot have to expect from it. */
static double expected_at(struct cells *cells, const struct cells_fields *fields, size_t slot,
                          struct lanes *lanes)
{
    const double *disturbance = cells->quiet->disturbance;
    const int32_t *slots = list_of(cells, slot, lanes);
    const int32_t count = cells->lists[slot].count;
    double around = 0;
    for (int32_t k = 0; k < count; k++) {
        int mirrored;
        const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
        around = largest(around, disturbance[j]);
    }
    return largest(disturbance[cells->order[slot]], carried(cells) * around);
}

/* Part of the disturbance of particle `from`, at slot or other, that arrives at particle `to`. */
static double part_of(const struct cells *cells, const struct cells_fields *fields, size_t slot,
                      size_t other, size_t to, size_t from)
{
    const double r = sqrt(cells_distance2(cells, slot, other));
    const double h = 1 / fmin(fields->h_inverse[to], fields->h_inverse[from]);
    const double slope = kernel_dr(cells->method.kernel, r, h, cells->method.box.dim);
    return terms * fields->V[from] * h * fabs(slope);
}

/* For an awake particle with a sleeping neighbour: the disturbance that its neighbours have to
 * expect. For others, which are most: -1. */
static void expect_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    double *expected = &cells->quiet->arriving[cells->order[slot]];
    *expected = -1;
    if (!grid_in_rim(cells->grid, slot)) return;
    const int32_t *slots = list_of(cells, slot, lanes);
    const int32_t count = cells->lists[slot].count;
    for (int32_t k = 0; k < count && *expected < 0; k++) {
        int mirrored;
        if (cells->asleep[lanes_source(cells, fields->n, (size_t)slots[k], &mirrored)])
            *expected = expected_at(cells, fields, slot, lanes);
    }
}

/* `arriving` holds, for awake particles, what their sleeping neighbours have to expect, and for
 * sleeping particles the sum that arrives, added by one thread in the order of the slots. */
void cells_wake(struct cells *cells, const struct cells_fields *fields,
                const struct cells_quiet *quiet, unsigned char *asleep)
{
    cells->quiet = quiet;
    cells->asleep = asleep;
    memset(quiet->arriving, 0, fields->n * sizeof *quiet->arriving);
    grid_find_rim(cells->grid, asleep);
    lanes_all(cells, fields, expect_pass);
    for (size_t slot = 0; slot < cells->points; slot++) {
        if (!cells->lists[slot].kept) continue; /* asleep, or a wall image */
        const size_t i = cells->order[slot];
        const double expected = quiet->arriving[i];
        if (expected < 0) continue;
        const int32_t *slots = list_of(cells, slot, &cells->lanes[0]);
        const double limit2 = square_of_limit(fields, quiet, i);
        const int32_t count = cells->lists[slot].count;
        for (int32_t k = 0; k < count; k++) {
            int mirrored;
            const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
            if (!asleep[j]) continue;
            if (!(expected <= 1))
                quiet->arriving[j] +=
                    expected * part_of(cells, fields, slot, (size_t)slots[k], j, i);
            if (!(quiet->arriving[j] <= 1 && passing2(cells, fields, i, j, mirrored) <= limit2))
                asleep[j] = 0;
        }
    }
}

/* True if the particle at a slot is calm, moves with all its neighbours, and receives no more than
 * `calm` from neighbours that are not calm. */
static bool calm_around(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    const struct cells_quiet *quiet = cells->quiet;
    const size_t i = cells->order[slot];
    const double limit2 = square_of_limit(fields, quiet, i) * quiet->calm * quiet->calm;
    if (!(quiet->disturbance[i] <= quiet->calm)) return false;
    const int32_t *slots = list_of(cells, slot, lanes);
    const int32_t count = cells->lists[slot].count;
    double sum = 0;
    for (int32_t k = 0; k < count; k++) {
        int mirrored;
        const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
        if (!(quiet->arriving[j] <= quiet->calm))
            sum += quiet->arriving[j] * part_of(cells, fields, slot, (size_t)slots[k], i, j);
        if (!(sum <= quiet->calm && passing2(cells, fields, i, j, mirrored) <= limit2))
            return false;
    }
    return true;
}

static void arrive_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                        struct lanes *lanes)
{
    cells->quiet->arriving[cells->order[slot]] = expected_at(cells, fields, slot, lanes);
}

static void sleep_pass(struct cells *cells, const struct cells_fields *fields, size_t slot,
                       struct lanes *lanes)
{
    if (calm_around(cells, fields, slot, lanes))
        cells->asleep[cells->order[slot]] = CELLS_JUST_ASLEEP;
}

void cells_fall_asleep(struct cells *cells, const struct cells_fields *fields,
                       const struct cells_quiet *quiet, unsigned char *asleep)
{
    cells->quiet = quiet;
    cells->asleep = asleep;
    memset(quiet->arriving, 0, fields->n * sizeof *quiet->arriving);
    lanes_all(cells, fields, arrive_pass);
    lanes_all(cells, fields, sleep_pass);
}
