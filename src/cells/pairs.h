/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the pair forces in 2D and 3D: the arrays that one stage passes to the next. */
#ifndef SPHPROOF_PAIRS_H
#define SPHPROOF_PAIRS_H

#include "lanes.h"

/* The current pairs of one particle: as many of its neighbours as fit into the lanes. */
struct pairs {
    int count;      /* number of lanes, a multiple of the vector length */
    int neighbours; /* lanes with a neighbour; the rest hold the sentinel */
    const struct lanes *lanes;
    const struct lanes_layout *layout;
    const double *record; /* of the particle itself */
    int reacting;         /* the first lanes, whose neighbours receive a reaction */
    const int32_t *slots; /* slot of each lane */
};

/* The particle's own value or values of a field of the records. */
static inline const double *pairs_own(const struct pairs *pairs, enum lanes_field field)
{
    return pairs->record + pairs->layout->offset[field];
}

/* The neighbours' values of a field; further components follow at a distance of lanes->stride. */
static inline const double *pairs_others(const struct pairs *pairs, enum lanes_field field)
{
    return lane_of(pairs->lanes, pairs->layout, field);
}

/* Writes to the lanes of these names: G, the mean of both particles' gradients, for every pair and
 * axis, and, with the lagrangian formulation, G_i and G_j. */
void cells_pair_gradients(const struct cells *cells, const struct pairs *pairs);

/* Computes K of every pair, the viscous term added to both a_i and a_j. Returns false, with K = 0,
 * if all neighbours are still (cells_method). */
bool cells_viscosity(const struct cells *cells, const struct pairs *pairs);

/* P of `projected` from a velocity gradient L: the matrix that removes noise along resolved shear.
 */
void cells_project(int dim, const double L[CELLS_SQUARE], double projector[CELLS_SYMMETRIC]);

/* Changes the mean G of every pair so that the gradient of a constant vanishes, CONVENTIONS
 * eq. 6.16. */
void cells_close(const struct cells *cells, const struct pairs *pairs);

/* Adds to gained the exchange of shifting: momentum along each axis, energy, mass; then the
 * remaining gradient of a constant with closed gradients. */
void cells_exchange(const struct cells *cells, const struct pairs *pairs, double *gained);

/* The heat conducted to the particle. */
double cells_conduction(const struct cells *cells, const struct pairs *pairs);

/* sum_j V_j v_ij . G: div v of CONVENTIONS with the pair gradient. */
double cells_divergence(const struct cells *cells, const struct pairs *pairs);

#endif
