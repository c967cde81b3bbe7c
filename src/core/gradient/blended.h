/* SPDX-License-Identifier: GPL-3.0-or-later
 * ia, blended with the standard gradient where h changes steeply, CONVENTIONS eq. 4.8: a pair has b
 * of the standard gradient and 1 - b of ia, b the mean of both particles' weights. */
#ifndef GRADIENT_BLENDED_H
#define GRADIENT_BLENDED_H

ALWAYS_INLINE double blended_weight(double w, double slope)
{
    (void)slope;
    return w;
}

/* b_i = smoothstep((|grad h| - 0.05)/0.1), grad h by linear_exact. */
static inline double blended_share(double steepness)
{
    const double t = least(1, largest(0, (steepness - 0.05) / 0.1));
    return t * t * (3 - 2 * t);
}

#endif
GRADIENT(blended, .member = {"blended", "ia, but standard where h changes steeply", ""},
         .least_dim = 2, .weight = WEIGHT_W, .share = blended_share)
