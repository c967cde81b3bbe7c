/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernel shapes over an array of q: one vectorised loop stamped for every kernel, dimension and
 * shape function, so that sums over gathered neighbours pay one call a point, not one a pair. */
#ifndef SPHPROOF_SHAPES_H
#define SPHPROOF_SHAPES_H

#include <stdbool.h>
#include <stddef.h>

#include "kernel.h"

/* value[i] = w(q[i]) or dw/dq(q[i]), i = 0..n-1, q >= 0; the arrays must not overlap. */
typedef void shapes_loop(const struct kernel *kernel, size_t n, const double *q, double *value);

struct shapes {
    shapes_loop *w, *dw;
};

/* The loops for this kernel in dim dimensions: stamped ones where both its shape functions are
 * those of a built-in kernel and stamped is wanted; else loops that call through its pointers. */
struct shapes shapes_of(const struct kernel *kernel, int dim, bool stamped);

#endif
