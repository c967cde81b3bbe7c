/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fastest possible gradient operator: its arithmetic on neighbours that are contiguous in
 * memory, without search, gathering or branches. It is an independent implementation, so that it
 * also gives the expected sums. */
#pragma once

#include "operator.h"

/* Neighbours of one point, in units of h: positions relative to it, volumes, field values; n each,
 * n a multiple of 8. */
struct bench_neighbours {
    size_t n;
    const double *x[3], *volume, *f;
};

/* sums: the operator's sums over neighbours (see bench_limit.c); at least 32 numbers. */
typedef void bench_limit_loop(const struct kernel *kernel, const struct bench_neighbours *list,
                              double *sums);
enum { BENCH_LIMIT_SUMS = 32 };

/* The specialised loop for a built-in kernel; NULL: a plug-in. */
bench_limit_loop *bench_limit_find(const struct kernel *kernel, const struct operator_form *form,
                                   int dim);

/* The number of n positions (n a multiple of 64) within distance 1 of the origin: the minimal work
 * of a search whose candidates are contiguous, in single precision. dim is 2 or 3. */
size_t bench_limit_near(int dim, size_t n, const float *const x[3]);

/* Candidates per neighbour of a search through cells as wide as the radius. */
double bench_limit_candidates(int dim);

/* The gradient at the point from the sums; f_0: the field there, h its support radius. False if the
 * matrix is singular. */
bool bench_limit_gradient(const struct kernel *kernel, const struct operator_form *form, int dim,
                          const double *sums, double f_0, double h, double *gradient);
