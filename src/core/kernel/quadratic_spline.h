/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quadratic B-spline M3 in truncated powers: w = (1-q)^2 - 3 (1/3-q)+^2. */
#ifndef KERNEL_QUADRATIC_SPLINE_H
#define KERNEL_QUADRATIC_SPLINE_H

static inline double quadratic_spline_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 1. / 3 - q > 0 ? 1. / 3 - q : 0;
    return a * a - 3 * (b * b);
}

static inline double quadratic_spline_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 1. / 3 - q > 0 ? 1. / 3 - q : 0;
    return -2 * (a - 3 * b);
}

#endif
KERNEL(quadratic_spline, .member = {"quadratic_spline", "quadratic B-spline M3", "Schoenberg 1946"},
       .constant = {0, 27. / 16, 81 / (13 * M_PI), 243 / (32 * M_PI)}, .knot_count = 1,
       .knots = (const double[]){1. / 3}, .smoothness = {0, 1, 1, 1}, .unity_width = 1.5,
       .default_eta = 1.5, .cloud_eta = 2,
       .stable_eta = {[GRADIENT_STANDARD] = 3, [GRADIENT_IA] = 3.64},
       .predicted = {.alpha = 0.75, .cfl = 1.1, .pair_width = PAIR_WIDTH_MAX})
