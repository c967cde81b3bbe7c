/* SPDX-License-Identifier: GPL-3.0-or-later
 * Matrices of 1x1 to 3x3, row-major with row length dim: a[i * dim + j]. */
#ifndef SPHPROOF_MATRIX_H
#define SPHPROOF_MATRIX_H

#include <stdbool.h>

/* Computes the inverse of a: by cofactors where that is safe, otherwise by elimination with
 * complete pivoting on rows and columns scaled to a largest element of 1, so that axes of very
 * different extent cost no accuracy. Returns false, and leaves inverse unchanged, if a is singular
 * in double precision (scaled condition number above 1/(16 epsilon)) or not finite. */
bool matrix_invert(int dim, const double *a, double *inverse);

/* Condition number of a in the 2-norm: largest over smallest singular value, by one-sided Jacobi
 * rotations, which are accurate for small singular values too. INFINITY if a is singular, NAN if it
 * is not finite. */
double matrix_condition(int dim, const double *a);

#endif
