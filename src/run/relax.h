/* SPDX-License-Identifier: GPL-3.0-or-later
 * Glasses: points relaxed by mutual repulsion, each with a prescribed volume (weighted Voronoi
 * tessellations, Diehl et al. 2015). They have no preferred directions, unlike a lattice, and much
 * smaller density fluctuations than random points. Code units. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "field.h"
#include "regularity.h"
#include "status.h"

/* The region to fill: a periodic box in 2 or 3 dimensions. */
struct relax_region {
    struct domain box;
    /* Volume of a point at x; the volumes of all points add up to about that of the box. */
    double (*volume)(const void *context, const double x[3]);
    const void *context;
};

/* Relaxes n points in sweeps, or reads the result from the cache (relax_store_find).
 * STATUS_BAD_INPUT: too few points for a neighbourhood; or no memory. */
enum status relax_points(const struct relax_region *region, size_t n, double *const x[3],
                         struct error *error);

/* Regularity of any n points with the given volumes, by the kernel wendland_c4 at eta = 3.6. Random
 * points have a density of about 0.15, a gradient of 0.3 and a spread of 0.5. */
enum status relax_measure(const struct domain *box, size_t n, const double *const x[3],
                          const double *volume, struct regularity *quality, struct error *error);

/* A cache of relaxed points, by content, in the user's cache folder
 * ($XDG_CACHE_HOME/sphproof/glass, else ~/.cache/sphproof/glass; unused if there is no such
 * folder), valid for this build of the program only. Storing an entry removes those that have not
 * been used for a month.
 *
 * Numbers of points that are stored: fewer are faster to relax than to read, more take too much
 * disk space. */
enum { RELAX_STORE_LEAST = 1000, RELAX_STORE_MOST = 300000 };

/* content: a hash of everything that determines the n points. Returns false and leaves x unchanged
 * if they are not stored. */
bool relax_store_find(uint64_t content, int dim, size_t n, double *const x[3]);

/* Stores the points. Failures are ignored: the next run relaxes the points again. */
void relax_store_keep(uint64_t content, int dim, size_t n, double *const x[3]);
