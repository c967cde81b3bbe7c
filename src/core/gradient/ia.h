/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Integral Approach, CONVENTIONS eq. 4.3 (Garcia-Senz, Cabezon & Escartin 2012) in conservative
 * form: G_i = C_i x W with C_i the inverse of sum_j V_j x x^T W. */
#ifndef GRADIENT_IA_H
#define GRADIENT_IA_H

ALWAYS_INLINE double ia_weight(double w, double slope)
{
    (void)slope;
    return w;
}

#endif
GRADIENT(ia,
         .member = {"ia", "Integral Approach, conservative form, C x W",
                    "Garcia-Senz, Cabezon & Escartin 2012"},
         .least_dim = 1, .weight = WEIGHT_W)
