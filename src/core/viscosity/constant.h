/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fixed alpha and beta (Monaghan 1992), CONVENTIONS eqs. 5.6 to 5.8: PI = (-alpha cbar mu + beta
 * mu^2)/rhobar where a pair approaches. */
#ifndef VISCOSITY_CONSTANT_H
#define VISCOSITY_CONSTANT_H

ALWAYS_INLINE struct viscosity_terms constant_viscous(const struct pair_numbers *numbers,
                                                      const struct pair_side *i,
                                                      const struct pair_side *j,
                                                      const struct viscosity_pair *pair)
{
    return (struct viscosity_terms){.closing = largest(pair->closing, 0),
                                    .scale = 1,
                                    .alpha_half = 0.5 * numbers->alpha,
                                    .beta = numbers->beta,
                                    .c_sum = i->c + j->c,
                                    .factor = pair->factor};
}

#endif
VISCOSITY(constant, .member = {"constant", "fixed alpha and beta", "Monaghan 1992"}, .least_dim = 1,
          .parameters = "alpha beta viscosity_form balsara")
