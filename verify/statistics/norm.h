/* SPDX-License-Identifier: GPL-3.0-or-later
 * Error norms over the measure window M of a case: with w_i the volumes,
 *   L1 = sum w_i |q_i - e_i| / sum w_i,  L2 = sqrt(sum w_i (q_i - e_i)^2 / sum w_i),
 *   Linf = max |q_i - e_i|,  particle mean = sum |q_i - e_i| / number in M;
 * in the units of the field q. One definition for every command and report. */
#ifndef SPHPROOF_NORM_H
#define SPHPROOF_NORM_H

#include <stddef.h>

enum { NORM_BINS = 20, NORM_BINS_MAX = 64 };

struct norms {
    double l1, l2, linf, particle_mean; /* NaN where no particle lies in the window */
    double l1_cut;                      /* see norm_l1_cut; where nobody has cut anything: l1 */
    size_t n;                           /* particles in the window */
};

/* x, volume, value, exact: n each; exact[i] belongs to the particle's own position. In the window:
 * window[0] <= x <= window[1]. A NaN among the values makes every norm NaN. */
struct norms norm_errors(size_t n, const double *x, const double window[2], const double *volume,
                         const double *value, const double *exact);

/* L1 with volumes cut at the window's edge (on a line): each particle fills the cell of the length
 * volume[i] about x[i], and w_i is what of it lies in the window, also of its images a period away.
 * L1 jumps where a particle crosses the edge, by its volume times its error; this does not. */
double norm_l1_cut(size_t n, const double *x, const double window[2], double period,
                   const double *volume, const double *value, const double *exact);

/* An exact solution at one instant. */
typedef double norm_field(const void *context, double x);

/* Means of an exact solution over each of bins equal parts of the window (adaptive Gauss-Kronrod,
 * relative 1e-10 also across jumps). */
void norm_bin_means(norm_field *field, const void *context, const double window[2], size_t bins,
                    double *means);

/* The seed program's binned error, corrected: mean over the bins that hold particles of
 * |exact_mean - sum w_i q_i / sum w_i|; parts are half open, the last one closed. bins <=
 * NORM_BINS_MAX (NORM_BINS is the standard); NaN where the window is empty. */
double norm_binned_l1(size_t n, const double *x, const double window[2], const double *volume,
                      const double *value, size_t bins, const double *exact_means);

#endif
