/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quintic B-spline M6 in truncated powers: w = (1-q)^5 - 6 (2/3-q)+^5 + 15 (1/3-q)+^5. */
#ifndef KERNEL_QUINTIC_SPLINE_H
#define KERNEL_QUINTIC_SPLINE_H

static inline double quintic_spline_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 2. / 3 - q > 0 ? 2. / 3 - q : 0;
    const double c = 1. / 3 - q > 0 ? 1. / 3 - q : 0;
    const double a2 = a * a, b2 = b * b, c2 = c * c;
    return a2 * a2 * a - 6 * (b2 * b2 * b) + 15 * (c2 * c2 * c);
}

static inline double quintic_spline_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 2. / 3 - q > 0 ? 2. / 3 - q : 0;
    const double c = 1. / 3 - q > 0 ? 1. / 3 - q : 0;
    const double a2 = a * a, b2 = b * b, c2 = c * c;
    return -5 * (a2 * a2 - 6 * (b2 * b2) + 15 * (c2 * c2));
}

#endif
KERNEL(quintic_spline, .member = {"quintic_spline", "quintic B-spline M6", "Schoenberg 1946"},
       .constant = {0, 243. / 40, 15309 / (478 * M_PI), 2187 / (40 * M_PI)}, .knot_count = 2,
       .knots = (const double[]){1. / 3, 2. / 3}, .smoothness = {0, 4, 4, 4}, .unity_width = 3,
       .default_eta = 3, .cloud_eta = 3, .stable_eta = {[GRADIENT_IA] = 6.01})
