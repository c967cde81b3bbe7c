/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of the pair forces in 2D and 3D: what a stage hands on to the next. */
#ifndef SPHPROOF_SIDES_H
#define SPHPROOF_SIDES_H

#include "lanes.h"

/* The particle's own side, and the arrays that its neighbours' sides come from. */
struct sides {
    struct pair_side own;
    const double *m, *h, *h_inverse, *V, *P, *c, *rho, *alpha, *balsara, *b, *grad_h, *Z, *slope;
    double own_balsara;
    const double *own_slope;
};

/* G_i, G_j and their mean G of every pair, along every axis, into the lanes of these names;
 * neighbours: lanes that are no fillings, record: of the particle itself. */
void cells_pair_gradients(const struct cells *cells, int count, int neighbours,
                          const struct lanes *lanes, const double *record);

/* K of every pair: what viscosity adds to a_i and a_j alike. */
void cells_viscosity(const struct cells *cells, int count, const struct lanes *lanes,
                     const struct sides *sides, const double *record);

/* Heat that is conducted to the particle; u: specific energies of its neighbours. */
double cells_conduction(const struct cells *cells, int count, const struct sides *sides,
                        const struct lanes *lanes, double own_u, const double *u);

/* div v by the pair gradient. */
double cells_divergence(int dim, int count, const struct lanes *lanes, const struct sides *sides,
                        const double *v, const double *theirs);

#endif
