/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wendland C2 (Wendland 1995; Dehnen & Aly 2012): w = (1-q)^3 (1+3q) in 1D, (1-q)^4 (1+4q) in 2D
 * and 3D. Its lattice sums have no exact width; eta 2.5 has the smallest bias near its resolution
 * (density 2.4e-3, gradient 1.6e-3) below the limit 3.01 of ia. */
#ifndef KERNEL_WENDLAND_C2_H
#define KERNEL_WENDLAND_C2_H

static inline double wendland_c2_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0;
    return dim == 1 ? a * a * a * (1 + 3 * q) : (a * a) * (a * a) * (1 + 4 * q);
}

static inline double wendland_c2_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0;
    return dim == 1 ? -12 * q * (a * a) : -20 * q * (a * a * a);
}

#endif
KERNEL(wendland_c2, .member = {"wendland_c2", "Wendland C2", "Wendland 1995"},
       .constant = {0, 5. / 4, 7 / M_PI, 21 / (2 * M_PI)}, .smoothness = {0, 2, 2, 2},
       .default_eta = 2.5, .cloud_eta = 3, .stable_eta = {[GRADIENT_IA] = 3.01})
