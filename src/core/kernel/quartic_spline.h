/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quartic B-spline M5 in truncated powers: w = (1-q)^4 - 5 (3/5-q)+^4 + 10 (1/5-q)+^4. */
#ifndef KERNEL_QUARTIC_SPLINE_H
#define KERNEL_QUARTIC_SPLINE_H

static inline double quartic_spline_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 0.6 - q > 0 ? 0.6 - q : 0;
    const double c = 0.2 - q > 0 ? 0.2 - q : 0;
    return (a * a) * (a * a) - 5 * ((b * b) * (b * b)) + 10 * ((c * c) * (c * c));
}

static inline double quartic_spline_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel, (void)dim;
    const double a = 1 - q > 0 ? 1 - q : 0;
    const double b = 0.6 - q > 0 ? 0.6 - q : 0;
    const double c = 0.2 - q > 0 ? 0.2 - q : 0;
    return -4 * (a * a * a - 5 * (b * b * b) + 10 * (c * c * c));
}

#endif
KERNEL(quartic_spline, .member = {"quartic_spline", "quartic B-spline M5", "Schoenberg 1946"},
       .constant = {0, 3125. / 768, 46875 / (2398 * M_PI), 15625 / (512 * M_PI)}, .knot_count = 2,
       .knots = (const double[]){0.2, 0.6}, .smoothness = {0, 3, 3, 3}, .unity_width = 2.5,
       .default_eta = 2.5, .cloud_eta = 2.8,
       .stable_eta = {[GRADIENT_STANDARD] = 5, [GRADIENT_IA] = 5.94})
