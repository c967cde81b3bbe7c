/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the pair forces in 2D and 3D: the arrays that one stage passes to the next. */
#ifndef SPHPROOF_PAIRS_H
#define SPHPROOF_PAIRS_H

#include "lanes.h"

/* The pairs of one particle that are worked on: as many of its neighbours as fit in the lanes. */
struct pairs {
    int count;      /* lanes, in whole vectors */
    int neighbours; /* lanes that are neighbours; the rest is the sentinel's */
    const struct lanes *lanes;
    const struct lanes_layout *layout;
    const double *record; /* of the particle itself */
    int reacting;         /* the first lanes, whose neighbours get a reaction */
    const int32_t *slots; /* of the lanes */
};

/* The particle's own value or values of a field that its records have. */
static inline const double *pairs_own(const struct pairs *pairs, enum lanes_field field)
{
    return pairs->record + pairs->layout->offset[field];
}

/* Its neighbours' values; further values of the field lie a stride of the lanes apart. */
static inline const double *pairs_theirs(const struct pairs *pairs, enum lanes_field field)
{
    return lane_of(pairs->lanes, pairs->layout, field);
}

/* The mean G of both particles' gradients of every pair along every axis, and, for the lagrangian
 * form, G_i and G_j, into the lanes of these names. */
void cells_pair_gradients(const struct cells *cells, const struct pairs *pairs);

/* K of every pair: what viscosity adds to a_i and a_j alike. False where it vanishes, as all
 * neighbours are still (cells_method): K is 0. */
bool cells_viscosity(const struct cells *cells, const struct pairs *pairs);

/* P of `projected` from a velocity gradient, the matrix that takes noise along resolved shear out.
 */
void cells_project(int dim, const double L[CELLS_SQUARE], double projector[CELLS_SYMMETRIC]);

/* Changes the mean G of every pair so that their sum makes nothing of a constant, CONVENTIONS eq.
 * 6.16. */
void cells_close(const struct cells *cells, const struct pairs *pairs);

/* Adds to gained what the particle gains of what shifting sweeps over: momentum along every axis,
 * energy, mass; then what closed gradients still make of a constant. */
void cells_exchange(const struct cells *cells, const struct pairs *pairs, double *gained);

/* Adds to gained the heat that is conducted to the particle. False where no pair conducts any. */
bool cells_conduction(const struct cells *cells, const struct pairs *pairs, double *gained);

/* sum_j V_j v_ij . G, which is div v of CONVENTIONS with the pair gradient. */
double cells_divergence(const struct cells *cells, const struct pairs *pairs);

#endif
