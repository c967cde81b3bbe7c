/* SPDX-License-Identifier: GPL-3.0-or-later
 * Maps of a state: the particles of a plane, or of a slice through the middle of a box, are sorted
 * into cells about as wide as the particles' spacing. Code units. */
#pragma once

#include <stddef.h>

#include "field.h"
#include "simulation.h"

enum { MAP_CELLS = 256 }; /* in a direction: as many as a picture shows */

struct map {
    size_t nx, ny;
    double lo[2], hi[2];  /* what is mapped: the domain, in x and y */
    double slice[2];      /* from .. to in z (3D only) */
    size_t n, seen;       /* particles; those that are in a cell */
    double *x, *y;        /* nx and ny: centres of cells */
    size_t *count, *cell; /* nx ny: particles in a cell; n: the cell of each, nx ny: in none */
    size_t *covered; /* nx ny: seen particles within whose h, in the plane, a cell's centre is */
    void *storage;
};

/* Particles of a state in a domain of 2 or 3 dimensions; at most `most` cells in a direction. A
 * cell holds its lower edges; the last one of a row or column also its upper edge.
 * STATUS_ENVIRONMENT: no memory; else map_free. */
enum status map_create(struct map *map, const struct domain *domain, const struct snapshot *s,
                       size_t most, struct error *error);
void map_free(struct map *map);

/* z[j nx + i] is the mean of the n values over the particles in cell (i, j). An empty cell takes
 * the mean of the nearest cells that have particles. It is a void, NaN, where no particle's h
 * reaches or where no cell within MAP_REACH has particles. */
enum { MAP_REACH = 4 };
void map_mean(const struct map *map, const double *values, double *z);
