/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of cells: moments over the neighbours of one particle, which matrices and linear_exact
 * gradients are made of. */
#ifndef SPHPROOF_MOMENTS_H
#define SPHPROOF_MOMENTS_H

#include "lanes.h"

/* The weights V w(q) of every neighbour into LANE_W_J, w(q) into LANE_W; V: the neighbours'. */
void moments_weigh(const struct cells *cells, int count, const struct lanes *lanes,
                   double h_inverse, const double *V);

/* The inverse of the moments sum weight x x^T. False where it is not to be used (CONVENTIONS eq.
 * 4.7): too few neighbours, or nearly on a line or in a plane. *condition is that of Frobenius'
 * norm, which is never less than the 2-norm's; that is found where it decides. */
bool moments_invert(const struct cells_method *method, int count, const struct lanes *lanes,
                    const double *weight, double inverse[CELLS_SQUARE], double *condition);

/* The linear_exact gradient of a vector f (CONVENTIONS eq. 4.4), d f_a/d x_b at a dim + b:
 * C sum weight x (f_a - own_a); f: the neighbours', axes a stride of the lanes apart. */
void moments_gradient(int dim, int count, const struct lanes *lanes, const double *weight,
                      const double inverse[CELLS_SQUARE], const double *f, const double *own,
                      double gradient[CELLS_SQUARE]);

/* The same gradient of a number; of f = 1 and own = 0 what the gradient makes of a constant.
 * Returns its length. */
double moments_slope(int dim, int count, const struct lanes *lanes, const double *weight,
                     const double inverse[CELLS_SQUARE], const double *f, double own,
                     double slope[3]);

#endif
