/* SPDX-License-Identifier: GPL-3.0-or-later
 * Glasses: points that have pushed each other apart until none is pushed any more, each keeping as
 * much room as it is asked to (weighted Voronoi tessellations, Diehl et al. 2015). They have no
 * directions, unlike a lattice, and few of the fluctuations of random points. Code units. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "field.h"
#include "status.h"

/* What is to be filled: a periodic box in 2 or 3 dimensions. */
struct relax_region {
    struct domain box;
    /* Room that a point at x takes: of all points together about the box. */
    double (*volume)(const void *context, const double x[3]);
    const void *context;
};

/* How good points are, by sums with the kernel wendland_c4 at eta = 3.6: rms of what sum V W
 * departs from 1, and of h |sum V grad W|, 0 on a lattice; and the deviation of the distances of
 * nearest neighbours, over their mean. Random points: about 0.15, 0.3 and 0.5. */
struct relax_quality {
    double density, gradient, spread;
};

/* Moves n points, sweep by sweep; those that have been moved so before are read where they are
 * kept (relax_store_find). STATUS_BAD_INPUT: too few for a neighbourhood; or no memory. */
enum status relax_points(const struct relax_region *room, size_t n, double *const x[3],
                         struct error *error);

/* Of any points: rooms as they are given, n each. */
enum status relax_measure(const struct domain *box, size_t n, const double *const x[3],
                          const double *volume, struct relax_quality *quality, struct error *error);

/* Points that have been relaxed before are kept by content in the user's cache folder
 * ($XDG_CACHE_HOME/sphproof/glass, else ~/.cache/sphproof/glass; none where there is no such
 * folder), for this build of the program alone. Entries that have not been used for a month are
 * removed when others are stored.
 *
 * Numbers of points that are stored: fewer are relaxed faster than read, more fill the disk. */
enum { RELAX_STORE_LEAST = 1000, RELAX_STORE_MOST = 300000 };

/* content: a hash of all that decides where the n points end. Returns false, and leaves x alone, if
 * they are not stored. */
bool relax_store_find(uint64_t content, int dim, size_t n, double *const x[3]);

/* Stores the points. A failure is ignored: the next run relaxes them again. */
void relax_store_keep(uint64_t content, int dim, size_t n, double *const x[3]);
