/* SPDX-License-Identifier: GPL-3.0-or-later
 * Maps of a state: the particles of a plane, or of a slice through the middle of a 3D box, sorted
 * into cells about as wide as the particle spacing. Code units. */
#pragma once

#include <stddef.h>

#include "field.h"
#include "simulation.h"

enum { MAP_CELLS = 256 }; /* most cells in a direction of a picture */

struct map {
    size_t nx, ny;
    double lo[2], hi[2];  /* mapped region: the domain in x and y */
    double slice[2];      /* z range of the slice (3D) */
    size_t n, seen;       /* particles; particles that are in a cell */
    double *x, *y;        /* cell centres: nx and ny values */
    size_t *count, *cell; /* nx ny: particles in each cell; n: cell of each particle, nx ny: none */
    size_t *covered; /* nx ny: mapped particles whose h, projected on the plane, reaches the cell's
                        centre */
    void *storage;
};

/* Sorts the particles of a state in a 2D or 3D domain; `most`: largest number of cells in a
 * direction. A cell includes its lower edges; the last cell of a row or column also its upper edge.
 * STATUS_ENVIRONMENT: no memory; else free with map_free. */
enum status map_create(struct map *map, const struct domain *domain, const struct snapshot *s,
                       size_t most, struct error *error);
void map_free(struct map *map);

/* z[j nx + i] is the mean of the n values over the particles in cell (i, j). An empty cell takes
 * the mean of the nearest occupied cells. It is NaN, a void, if no particle's h reaches it or no
 * cell within MAP_REACH is occupied. */
enum { MAP_REACH = 4 };
void map_mean(const struct map *map, const double *values, double *z);
