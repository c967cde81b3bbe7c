/* SPDX-License-Identifier: GPL-3.0-or-later
 * Converts units for clouds whose lengths, weights or fields are so large or small that products
 * leave the range of double (a gradient contains V h^-(d+1): lengths of 1e80 suffice in 3D). The
 * units are powers of two, so that no digit changes: results differ only in their exponent. */
#ifndef SPHPROOF_UNITS_H
#define SPHPROOF_UNITS_H

#include <stdbool.h>
#include <stddef.h>

#include "neighbours.h"

/* True if all of n values are 0 or between 2^-UNITS_ORDINARY and 2^UNITS_ORDINARY in magnitude.
 * Then no product of a weight, a field and the fourth power of a length leaves the range. */
enum { UNITS_ORDINARY = 128 };
bool units_ordinary(size_t n, const double *values);

/* Exponent e of the unit 2^e in which the largest of n values is between 1/2 and 1; 0 if all are 0.
 */
int units_exponent(size_t n, const double *values);

/* A copy of n values in units of 2^e; the caller frees it. NULL: no memory. */
double *units_copy(size_t n, const double *values, int e);

/* Points in units of 2^e; false: no memory. Release with units_points_free. */
bool units_points(const struct points *points, int e, struct points *copy);
void units_points_free(struct points *copy);

#endif
