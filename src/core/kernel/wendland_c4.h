/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wendland C4 (Wendland 1995; Dehnen & Aly 2012): w = (1-q)^5 (1+5q+8q^2) in 1D,
 * (1-q)^6 (1+6q+35/3 q^2) in 2D and 3D. No width has exact lattice sums; eta 3: density 7e-4,
 * gradient 1.4e-3. */
#ifndef KERNEL_WENDLAND_C4_H
#define KERNEL_WENDLAND_C4_H

static inline double wendland_c4_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a;
    return dim == 1 ? a2 * a2 * a * (1 + q * (5 + 8 * q))
                    : a2 * a2 * a2 * (1 + q * (6 + 35. / 3 * q));
}

static inline double wendland_c4_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a;
    return dim == 1 ? -14 * q * (a2 * a2) * (1 + 4 * q)
                    : -56. / 3 * q * (a2 * a2 * a) * (1 + 5 * q);
}

#endif
KERNEL(wendland_c4, .member = {"wendland_c4", "Wendland C4", "Wendland 1995"},
       .constant = {0, 3. / 2, 9 / M_PI, 495 / (32 * M_PI)}, .smoothness = {0, 4, 4, 4},
       .default_eta = 3, .cloud_eta = 3.6, .stable_eta = {[GRADIENT_IA] = 8.17})
