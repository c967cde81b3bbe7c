/* SPDX-License-Identifier: GPL-3.0-or-later
 * As constant, but quadratic in slow compression (von Neumann & Richtmyer 1950), CONVENTIONS
 * eq. 5.13: the linear term contains the sound speed only if a pair closes at more than a hundredth
 * of it, and a proportionally smaller speed below. Smooth flow is unaffected to second order,
 * shocks (0.1 c and more in a pair) are damped as before. */
#ifndef VISCOSITY_FADING_H
#define VISCOSITY_FADING_H

static const double fading_below = 0.01;

ALWAYS_INLINE struct viscosity_terms fading_viscous(const struct pair_numbers *numbers,
                                                    const struct pair_side *i,
                                                    const struct pair_side *j,
                                                    const struct viscosity_pair *pair)
{
    const double closing = largest(pair->closing, 0);
    return (struct viscosity_terms){.closing = closing,
                                    .scale = 1,
                                    .alpha_half = 0.5 * numbers->alpha,
                                    .beta = numbers->beta,
                                    .c_sum = least(i->c + j->c, closing * (2 / fading_below)),
                                    .factor = pair->factor};
}

#endif
VISCOSITY(fading,
          .member = {"fading", "constant, but quadratic in compression below 0.01 c a pair",
                     "von Neumann & Richtmyer 1950"},
          .least_dim = 1, .parameters = "alpha beta viscosity_form balsara")
