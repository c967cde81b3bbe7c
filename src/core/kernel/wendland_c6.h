/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wendland C6 (Wendland 1995; Dehnen & Aly 2012): w = (1-q)^7 (1+7q+19q^2+21q^3) in 1D,
 * (1-q)^8 (1+8q+25q^2+32q^3) in 2D and 3D. No width has exact lattice sums; eta 3.5: density
 * 2e-4, gradient 9e-4. */
#ifndef KERNEL_WENDLAND_C6_H
#define KERNEL_WENDLAND_C6_H

static inline double wendland_c6_w(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return dim == 1 ? a4 * a2 * a * (1 + q * (7 + q * (19 + q * 21)))
                    : a4 * a4 * (1 + q * (8 + q * (25 + q * 32)));
}

static inline double wendland_c6_dw(const struct kernel *kernel, double q, int dim)
{
    (void)kernel;
    const double a = 1 - q > 0 ? 1 - q : 0, a2 = a * a, a4 = a2 * a2;
    return dim == 1 ? -6 * q * (a4 * a2) * (3 + q * (18 + q * 35))
                    : -22 * q * (a4 * a2 * a) * (1 + q * (7 + q * 16));
}

#endif
KERNEL(wendland_c6, .member = {"wendland_c6", "Wendland C6", "Wendland 1995"},
       .constant = {0, 55. / 32, 78 / (7 * M_PI), 1365 / (64 * M_PI)}, .smoothness = {0, 6, 6, 6},
       .default_eta = 3.5, .cloud_eta = 4.8)
