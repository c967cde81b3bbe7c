/* SPDX-License-Identifier: GPL-3.0-or-later
 * Decides pair by pair which particles wake and which fall asleep in 2D and 3D. In one step a
 * signal reaches no further than the pairs of its sums. */
#include <math.h>

#include "cells.h"
#include "lanes.h"

static const int32_t *list_of(struct cells *cells, size_t slot)
{
    return grid_neighbours(cells->grid, &cells->lanes[0].reader, cells->lists, slot);
}

/* Speed at which a particle and its neighbour at a slot move against each other, squared. */
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

/* Raises the particle at a slot where it has a violent neighbour. */
static void raise_level(struct cells *cells, const struct cells_fields *fields,
                        const struct cells_quiet *quiet, size_t slot)
{
    const size_t i = cells->order[slot];
    if (quiet->level[i] >= CELLS_DISTURBED) return;
    const int32_t *slots = list_of(cells, slot);
    const int32_t count = cells->lists[slot].count;
    for (int32_t k = 0; k < count; k++) {
        int mirrored;
        if (quiet->level[lanes_source(cells, fields->n, (size_t)slots[k], &mirrored)] <
            CELLS_VIOLENT)
            continue;
        quiet->level[i] = CELLS_DISTURBED;
        return;
    }
}

void cells_wake(struct cells *cells, const struct cells_fields *fields,
                const struct cells_quiet *quiet, unsigned char *asleep)
{
    grid_find_rim(cells->grid, asleep);
    for (size_t slot = 0; slot < cells->points; slot++) {
        if (!grid_in_rim(cells->grid, slot)) continue;
        if (!cells->lists[slot].kept) continue; /* it sleeps, or is an image */
        raise_level(cells, fields, quiet, slot);
        const size_t i = cells->order[slot];
        const int32_t *slots = list_of(cells, slot);
        const double limit2 = square_of_limit(fields, quiet, i);
        const int32_t count = cells->lists[slot].count;
        for (int32_t k = 0; k < count; k++) {
            int mirrored;
            const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
            if (asleep[j] && !(quiet->level[i] < CELLS_DISTURBED &&
                               passing2(cells, fields, i, j, mirrored) <= limit2))
                asleep[j] = 0;
        }
    }
}

/* Are the particle at a slot and all its neighbours calm? */
static bool calm_around(struct cells *cells, const struct cells_fields *fields,
                        const struct cells_quiet *quiet, size_t slot)
{
    const size_t i = cells->order[slot];
    const double limit2 = square_of_limit(fields, quiet, i) * quiet->calm * quiet->calm;
    if (quiet->level[i] != CELLS_CALM) return false;
    const int32_t *slots = list_of(cells, slot);
    const int32_t count = cells->lists[slot].count;
    bool calm = true;
    for (int32_t k = 0; k < count && calm; k++) {
        int mirrored;
        const size_t j = lanes_source(cells, fields->n, (size_t)slots[k], &mirrored);
        calm = quiet->level[j] == CELLS_CALM && passing2(cells, fields, i, j, mirrored) <= limit2;
    }
    return calm;
}

size_t cells_lull(struct cells *cells, const struct cells_fields *fields,
                  const struct cells_quiet *quiet, unsigned char *asleep)
{
    size_t count = 0;
    for (size_t slot = 0; slot < cells->points; slot++)
        if (cells->lists[slot].kept) raise_level(cells, fields, quiet, slot);
    for (size_t slot = 0; slot < cells->points; slot++) {
        if (!cells->lists[slot].kept || !calm_around(cells, fields, quiet, slot)) continue;
        asleep[cells->order[slot]] = CELLS_JUST_ASLEEP;
        count++;
    }
    return count;
}
