/* SPDX-License-Identifier: GPL-3.0-or-later
 * The corrected gradient of the kernel, CONVENTIONS eq. 4.6 (Bonet & Lok 1999) in conservative
 * form: as ia with the weight -W'(r)/r in place of W, in the matrix and in the pair vector. */
#ifndef GRADIENT_CORRECTED_H
#define GRADIENT_CORRECTED_H

ALWAYS_INLINE double corrected_weight(double w, double slope)
{
    (void)w;
    return slope;
}

#endif
GRADIENT(corrected,
         .member = {"corrected", "as ia with the weight -W'/r in place of W",
                    "Bonet & Lok 1999, in conservative form"},
         .least_dim = 2, .weight = WEIGHT_SLOPE)
