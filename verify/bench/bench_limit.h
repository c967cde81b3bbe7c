/* SPDX-License-Identifier: GPL-3.0-or-later
 * The practical limit of a gradient operator: its arithmetic on neighbours that lie one after the
 * other in memory, with nothing to search, gather or choose. Written once more, so that it also
 * says what the sums must be. */
#pragma once

#include "operator.h"

/* Neighbours of one point, in units of h: positions relative to it, volumes, field values; n each,
 * n a multiple of 8. */
struct bench_neighbours {
    size_t n;
    const double *x[3], *volume, *f;
};

/* sums: what the operator needs of the neighbours (see bench_limit.c); at least 32 numbers. */
typedef void bench_limit_loop(const struct kernel *kernel, const struct bench_neighbours *list,
                              double *sums);
enum { BENCH_LIMIT_SUMS = 32 };

/* The specialised loop for a built-in kernel; NULL: it is a plug-in. */
bench_limit_loop *bench_limit_find(const struct kernel *kernel, const struct operator_form *form,
                                   int dim);

/* How many of n places, n a multiple of 64, lie nearer to 0 than 1: what a search cannot do without
 * once its candidates lie side by side, in single precision. dim is 2 or 3. */
size_t bench_limit_near(int dim, size_t n, const float *const x[3]);

/* Candidates that it has for each neighbour, where it looks through cells as wide as the radius. */
double bench_limit_candidates(int dim);

/* The gradient at the point from the sums; f_0: the field there, h its support radius. False where
 * the matrix has no inverse. */
bool bench_limit_gradient(const struct kernel *kernel, const struct operator_form *form, int dim,
                          const double *sums, double f_0, double h, double *gradient);
