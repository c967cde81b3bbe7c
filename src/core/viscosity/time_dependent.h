/* SPDX-License-Identifier: GPL-3.0-or-later
 * Each particle has an alpha (Morris & Monaghan 1997), CONVENTIONS eq. 5.9: it grows in compression
 * and decays afterwards, dalpha/dt = max(-div v, 0) (alpha_max - alpha) - (alpha - alpha_min)/tau,
 * tau = h/(0.2 c). A pair has the mean alpha of both particles; beta/alpha is constant. */
#ifndef VISCOSITY_TIME_DEPENDENT_H
#define VISCOSITY_TIME_DEPENDENT_H

ALWAYS_INLINE struct viscosity_terms time_dependent_viscous(const struct pair_numbers *numbers,
                                                            const struct pair_side *i,
                                                            const struct pair_side *j,
                                                            const struct viscosity_pair *pair)
{
    const double alpha_half = 0.25 * (i->alpha + j->alpha);
    return (struct viscosity_terms){.closing = largest(pair->closing, 0),
                                    .scale = 1,
                                    .alpha_half = alpha_half,
                                    .beta = 2 * numbers->beta_ratio * alpha_half,
                                    .c_sum = i->c + j->c,
                                    .factor = pair->factor};
}

static inline void time_dependent_evolve(const struct particles *a, ptrdiff_t first, int len,
                                         double alpha_min, double alpha_max)
{
    for (ptrdiff_t i = first; i < first + len; i++) {
        const double growth = largest(-a->div_v[i], 0) * largest(alpha_max - a->alpha[i], 0);
        a->dalpha[i] = growth - (a->alpha[i] - alpha_min) * 0.2 * a->c[i] / a->h[i];
    }
}

#endif
VISCOSITY(time_dependent,
          .member = {"time_dependent", "alpha grows in compression, decays behind",
                     "Morris & Monaghan 1997"},
          .least_dim = 1, .parameters = "beta alpha_min alpha_max viscosity_form balsara",
          .evolve = time_dependent_evolve)
