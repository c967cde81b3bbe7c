/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cubic B-spline M4 (Monaghan & Lattanzio 1985) in truncated powers: no branch, vectorises.
 * w = 1 - 6 q^2 + 6 q^3 for q <= 1/2, 2 (1-q)^3 beyond. */
#ifndef KERNEL_CUBIC_SPLINE_H
#define KERNEL_CUBIC_SPLINE_H

static inline double cubic_spline_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 0.5 - q > 0 ? 0.5 - q : 0;
    return 2 * (a * a * a - 4 * (b * b * b));
}

static inline double cubic_spline_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 0.5 - q > 0 ? 0.5 - q : 0;
    return -6 * (a * a - 4 * (b * b));
}

#endif
KERNEL(cubic_spline, .member = {"cubic_spline", "cubic B-spline M4", "Monaghan & Lattanzio 1985"},
       .constant = {0, 4. / 3, 40 / (7 * M_PI), 8 / M_PI}, .knot_count = 1,
       .knots = (const double[]){0.5}, .smoothness = {0, 2, 2, 2}, .unity_width = 2,
       .default_eta = 2, .cloud_eta = 2.4, .stable_eta = {[GRADIENT_IA] = 4})
