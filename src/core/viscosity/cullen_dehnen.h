/* SPDX-License-Identifier: GPL-3.0-or-later
 * Each particle has an alpha that a switch sets once per step (Cullen & Dehnen 2010), CONVENTIONS
 * eqs. 6.6 and 6.7: it jumps up to alpha_loc where div v decreases, and decays to it afterwards. h
 * is the support radius, about twice the h of the paper. A pair has the mean alpha of both
 * particles; beta/alpha is constant. */
#ifndef VISCOSITY_CULLEN_DEHNEN_H
#define VISCOSITY_CULLEN_DEHNEN_H

ALWAYS_INLINE struct viscosity_terms cullen_dehnen_viscous(const struct pair_numbers *numbers,
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

/* xi of eq. 6.7: 1 in compression, 0 in shear. */
static inline double cullen_dehnen_limiter(const struct viscosity_flow *flow)
{
    const int dim = flow->dim;
    const double *L = flow->L, divergence = flow->divergence;
    double shear = -divergence * divergence / dim;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            const double s = 0.5 * (L[a * dim + b] + L[b * dim + a]);
            shear += s * s;
        }
    const double one = 1 - flow->R, t = 2 * (one * one * one * one) * divergence;
    return t * t > 0 ? t * t / (t * t + largest(shear, 0)) : 0;
}

static inline struct viscosity_goal cullen_dehnen_goal(const struct viscosity_flow *flow)
{
    const double A = cullen_dehnen_limiter(flow) * largest(-flow->change, 0);
    return (struct viscosity_goal){
        .alpha = largest(flow->alpha_min, flow->alpha_max * (A / (A + flow->rate * flow->rate))),
        .decay = 2 * 0.05 * flow->rate};
}

#endif
VISCOSITY(cullen_dehnen,
          .member = {"cullen_dehnen", "alpha jumps up where div v falls, decays behind",
                     "Cullen & Dehnen 2010"},
          .least_dim = 2, .parameters = "beta alpha_min alpha_max viscosity_form balsara",
          .find_goal = cullen_dehnen_goal)
