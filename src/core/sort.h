/* SPDX-License-Identifier: GPL-3.0-or-later
 * A stable merge sort of the sorted runs that exist: n comparisons for one run, otherwise about n
 * log2(runs), for any initial order. Allocates no memory. */
#ifndef SPHPROOF_SORT_H
#define SPHPROOF_SORT_H

#include <stddef.h>

/* Sorts order (n indices into x) by ascending x; equal values keep their order. x contains no NaN.
 * other: work array of n. Returns the number of comparisons. */
size_t sort_indices(const double *x, size_t n, size_t *order, size_t *other);

#endif
