/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gathers and transposes the records of neighbours: the values of one particle, adjacent in memory,
 * go to one array for each value, which loops over neighbours read in whole vectors. Data is only
 * moved, so the result does not depend on the instruction set. */
#ifndef SPHPROOF_GATHER_H
#define SPHPROOF_GATHER_H

#include <stddef.h>
#include <stdint.h>

enum { GATHER_GROUP = 4 }; /* doubles; a record is whole groups, aligned to 32 bytes */

/* out[f * stride + k] = records[slots[k] * size + f], f = 0 .. size-1, k = 0 .. count-1; size in
 * whole groups, count a multiple of 8; records aligned to 32 bytes. */
typedef void gather_loop(const double *records, int size, const int32_t *slots, int count,
                         double *out, ptrdiff_t stride);

/* The fastest loop that this processor supports, for records of this size. */
gather_loop *gather_choose(int size);

#endif
