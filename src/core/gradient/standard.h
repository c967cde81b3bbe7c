/* SPDX-License-Identifier: GPL-3.0-or-later
 * The derivative of the kernel, CONVENTIONS eq. 4.1: grad_i W = C h^-(d+2) x (-w'(q)/q), x = r_j -
 * r_i. */
#ifndef GRADIENT_STANDARD_H
#define GRADIENT_STANDARD_H

ALWAYS_INLINE double standard_weight(double w, double slope)
{
    (void)w;
    return slope;
}

#endif
GRADIENT(standard, .member = {"standard", "derivative of the kernel, e_ij dW/dr", "Monaghan 1992"},
         .least_dim = 1, .weight = WEIGHT_NONE)
