/* SPDX-License-Identifier: GPL-3.0-or-later
 * The arithmetic of one range that has no pairs in it: state, widths, equation of state, limits.
 * Plain loops over particles, stamped over instruction sets like the sums. */
#ifndef SPHPROOF_RANGE_H
#define SPHPROOF_RANGE_H

#include "loops.h"
#include "plan.h"

/* v = p/m and U = e (- p^2/2m where kinetic = 1/2, 0 where e is U already). Returns how many of the
 * len particles from first have no positive U (NaN counts). */
double range_primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
                        double kinetic);

/* Neighbours out of order among the first len + 1 particles from first (NaN counts). */
double range_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len);

/* Particles of the range with the neighbour at offset d inside their own width. */
double range_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d);

/* 1/h for the next density sum: as last found, extrapolated by ratio times its last change. */
void range_predict_width(const struct particles *particles, ptrdiff_t first, int len, double ratio);

/* The numbers of the equation of state: constant = C_1 of the kernel; follow = how strongly the
 * pressure follows a volume that was predicted too small or too large (integrator.h). */
struct gas {
    double gamma, constant, eta, follow;
};

/* Equation of state and what the pair sums need of it; h as the sum of mass has found it. Returns
 * how many widths that were predicted are far from those. */
double range_close(const struct particles *particles, ptrdiff_t first, int len,
                   const struct plan *plan, const struct gas *gas, const struct density_sums *sums);

/* Is the width of particle i that was predicted far from the one that the sum has found? */
bool range_surprised(const struct particles *particles, ptrdiff_t i);

/* The largest signal speed / h. */
double range_rate(const struct particles *particles, ptrdiff_t first, int len);

#endif
