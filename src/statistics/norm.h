/* SPDX-License-Identifier: GPL-3.0-or-later
 * Error norms over the measure window M of a case, in the units of the field q:
 *   L1 = sum w_i |q_i - e_i| / sum w_i, w_i the part of the volume V_i that lies in M;
 * and of the particles that lie in M, with their whole volumes
 *   L1 whole = sum V_i |q_i - e_i| / sum V_i,  L2 = sqrt(sum V_i (q_i - e_i)^2 / sum V_i),
 *   Linf = max |q_i - e_i|,  particle mean = sum |q_i - e_i| / number in M.
 * L1 is continuous in all positions; the others jump where a particle crosses the edge of M. One
 * definition for every command and report. */
#pragma once

#include <stddef.h>

enum { NORM_BINS = 20, NORM_BINS_MAX = 64 };

struct norms {
    double l1, l2, linf, particle_mean; /* NaN where no particle lies in the window */
    double l1_whole;
    size_t n; /* particles in the window */
};

/* x, volume, value, exact: n each; exact[i] belongs to the particle's own position. In the window:
 * window[0] <= x <= window[1]. A NaN among the values makes every norm NaN. l1 is l1_whole, which a
 * caller who knows the w_i replaces. */
struct norms norm_errors(size_t n, const double *x, const double window[2], const double *volume,
                         const double *value, const double *exact);

/* L1 with the weights w_i. A particle with weight 0 is ignored, even if its value is NaN; a weight
 * that is NaN, or weights that are all 0, give NaN. */
double norm_l1(size_t n, const double *weight, const double *value, const double *exact);

/* An exact solution at one instant. */
typedef double norm_field(const void *context, double x);

/* Means of an exact solution over each of bins equal parts of the window (adaptive Gauss-Kronrod,
 * relative 1e-10 also across jumps). */
void norm_bin_means(norm_field *field, const void *context, const double window[2], size_t bins,
                    double *means);

/* The seed program's binned error, corrected: mean of |exact_mean - sum w_i q_i / sum w_i| over the
 * bins that contain particles; bins are half open, the last one closed. bins <= NORM_BINS_MAX
 * (NORM_BINS is the standard); NaN if the window is empty. */
double norm_binned_l1(size_t n, const double *x, const double window[2], const double *volume,
                      const double *value, size_t bins, const double *exact_means);
