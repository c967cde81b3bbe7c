/* SPDX-License-Identifier: GPL-3.0-or-later
 * A stable merge sort of the stretches that are in order already: n comparisons where there is one,
 * about n log2(stretches) otherwise, whatever the order that is given. Asks for no memory. */
#ifndef SPHPROOF_SORT_H
#define SPHPROOF_SORT_H

#include <stddef.h>

/* Puts order (n indices into x) into rising order of x; equal values keep theirs. Values are not
 * NaN. other: room for n. Returns the number of comparisons. */
size_t sort_indices(const double *x, size_t n, size_t *order, size_t *other);

#endif
