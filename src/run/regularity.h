/* SPDX-License-Identifier: GPL-3.0-or-later
 * Regularity of particle positions: distances of nearest neighbours, and the errors of kernel sums
 * for a constant field (lattice-sum errors of Quinlan et al. 2006; E0 in Price 2012). Code
 * units. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "problem.h"

/* Points with their volumes and smoothing lengths h; n each. */
struct regularity_cloud {
    struct domain box;
    bool periodic[3];
    size_t n;
    const double *x[3];
    const double *volume, *h;
    const struct kernel *kernel;
    int threads; /* used in 2D and 3D; 0: one; does not affect the result */
};

/* Distances are those of the nearest neighbour over volume^(1/d), at most the largest h. Sums
 * exclude points whose h reaches beyond a non-periodic end; NaN if none is left. Random points with
 * 53 neighbours have density about 0.15 and gradient 0.3. */
struct regularity {
    double nearest;  /* mean distance */
    double spread;   /* standard deviation of the distances over their mean */
    double paired;   /* fraction of points with a neighbour nearer than half a spacing */
    double density;  /* rms of sum V W - 1 */
    double gradient; /* rms of h |sum V grad W| */
};

/* `nearest` is 1 on a square or cubic lattice, 1.075 on a hexagonal and 1.122 on a face-centred
 * cubic one. STATUS_BAD_INPUT: an h exceeds half a periodic side or is not finite; or no memory. */
enum status regularity_measure(const struct regularity_cloud *cloud, struct regularity *regularity,
                               struct error *error);

/* The regularity of a run's state with the run's kernel. NaN: unknown. */
struct regularity regularity_of(const struct prepared *p, const struct kernel *kernel,
                                const struct snapshot *s, int threads);
