/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to cells: moments over the neighbours of one particle, from which matrices and
 * linear_exact gradients follow. */
#ifndef SPHPROOF_MOMENTS_H
#define SPHPROOF_MOMENTS_H

#include "lanes.h"

/* Writes V w(q) of every neighbour to LANE_W_J and w(q) to LANE_W; V: of the neighbours. */
void moments_weigh(const struct cells *cells, int count, const struct lanes *lanes,
                   double h_inverse, const double *V);

/* Inverts the moments sum weight x x^T. Returns false if the inverse is unusable (CONVENTIONS
 * eq. 4.7): too few neighbours, or nearly on a line or in a plane. *condition is first computed in
 * the Frobenius norm, an upper bound; in the 2-norm only if that exceeds the limit. */
bool moments_invert(const struct cells_method *method, int count, const struct lanes *lanes,
                    const double *weight, double inverse[CELLS_SQUARE], double *condition);

/* The linear_exact gradient of a vector f (CONVENTIONS eq. 4.4), d f_a/d x_b at a dim + b: C sum
 * weight x (f_a - own_a); f: of the neighbours, axes lanes->stride apart. */
void moments_gradient(int dim, int count, const struct lanes *lanes, const double *weight,
                      const double inverse[CELLS_SQUARE], const double *f, const double *own,
                      double gradient[CELLS_SQUARE]);

/* Puts a particle into the next lane of a batch, with its moments. Returns the lane. */
int moments_put(const struct cells_method *method, int count, const struct lanes *lanes,
                const double *weight, size_t particle, struct moments_batch *batch);

/* Puts the sums weight x (f_a - own_a) of `fields` fields into a lane, those of field a along axis
 * b at a dim + b. */
void moments_put_differences(int dim, int fields, int count, const struct lanes *lanes,
                             const double *weight, const double *f, const double *own, int lane,
                             double (*sums)[GRID_LANES]);

/* Inverts the moments of a batch, as moments_invert does. */
void moments_solve(const struct cells_method *method, struct moments_batch *batch);

/* Replaces such sums by gradients; 0 without a usable inverse. */
void moments_apply(int dim, int fields, const struct moments_batch *batch,
                   double (*sums)[GRID_LANES]);

#endif
