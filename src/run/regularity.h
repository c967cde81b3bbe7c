/* SPDX-License-Identifier: GPL-3.0-or-later
 * How regular particles stand: distances of nearest neighbours, and what sums over a kernel make of
 * a constant (the lattice-sum errors of Quinlan et al. 2006 and Price 2012, there called E0). Code
 * units. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "problem.h"

/* Points with the volume that each stands for and the width h of its neighbourhood; n each. */
struct regularity_cloud {
    struct domain box;
    bool periodic[3];
    size_t n;
    const double *x[3];
    const double *volume, *h;
    const struct kernel *kernel;
    int threads; /* that share the work in 2D and 3D; 0: one. The result does not depend on it */
};

/* Distances are in spacings: of the nearest neighbour over volume^(1/d), a neighbour further away
 * than the widest h counting as that far. Sums: of points whose h does not reach beyond an end that
 * is not periodic; NaN where there is none. Random points at 53 neighbours: density about 0.15,
 * gradient 0.3. */
struct regularity {
    double nearest;  /* mean distance */
    double spread;   /* standard deviation of the distances, over their mean */
    double paired;   /* share of the points with a neighbour nearer than half a spacing */
    double density;  /* rms of sum V W - 1 */
    double gradient; /* rms of h |sum V grad W| */
};

/* The first is 1 on a square or cubic lattice, 1.075 on a hexagonal and 1.122 on the face-centred
 * cubic one. STATUS_BAD_INPUT: an h exceeds half a periodic side, or is not finite; or no memory.
 */
enum status regularity_measure(const struct regularity_cloud *cloud, struct regularity *regularity,
                               struct error *error);

/* Of a state of a run, with the kernel that the run has. NaN where it cannot be said. */
struct regularity regularity_of(const struct prepared *p, const struct kernel *kernel,
                                const struct snapshot *s, int threads);
