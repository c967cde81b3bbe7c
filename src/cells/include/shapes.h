/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernel shapes over an array of q: loops specialised for every kernel and dimension, so that sums
 * over gathered neighbours make one call for each point, not for each pair. */
#ifndef SPHPROOF_SHAPES_H
#define SPHPROOF_SHAPES_H

#include <stdbool.h>
#include <stddef.h>

#include "kernel.h"

/* value[i] = w(q[i]) or dw/dq(q[i]), i = 0..n-1, q >= 0; the arrays must not overlap. */
typedef void shapes_loop(const struct kernel *kernel, size_t n, const double *q, double *value);

/* The following loops take distances r; n is a multiple of 8. */

/* sums[0] = sum m w(q), sums[1] = sum m (d w + q w'), q = r h_inverse: times C/h^d and -C/h^(d+1)
 * the density and its derivative in h. */
typedef void shapes_sums(const struct kernel *kernel, size_t n, const double *r, double h_inverse,
                         const double *m, double sums[2]);

/* w = w(q), weight = V w(q), q = r h_inverse. */
typedef void shapes_weights(const struct kernel *kernel, size_t n, const double *r,
                            double h_inverse, const double *V, double *w, double *weight);

/* The shape function at both smoothing lengths of a pair: value at r h_inverse, value_j at r
 * others. */
typedef void shapes_pair(const struct kernel *kernel, size_t n, const double *r, double h_inverse,
                         const double *others, double *value, double *value_j);

struct shapes {
    shapes_loop *w, *dw;
    shapes_sums *sums;
    shapes_weights *weights;
    shapes_pair *pair_w, *pair_dw;
};

/* The loops for this kernel in dim dimensions: specialised ones if `specialised` and both its shape
 * functions are those of a built-in kernel; otherwise loops that call its pointers. */
struct shapes shapes_of(const struct kernel *kernel, int dim, bool specialised);

#endif
