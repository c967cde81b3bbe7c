/* SPDX-License-Identifier: GPL-3.0-or-later
 * Velocities extrapolated to the midpoint of the pair with a limited slope, CONVENTIONS eqs. 5.11
 * and 5.12 (Frontiere, Raskin & Owen 2017; Rosswog 2020, eqs. 18-22): closing + phi/2 (s_i + s_j) r
 * with phi = max(0, 4 s_i s_j/(s_i + s_j)^2) exp(-((q - near)/0.2)^2 where q = r/max(h_i, h_j) <
 * near), near = 1/eta. */
#ifndef VISCOSITY_RECONSTRUCTED_H
#define VISCOSITY_RECONSTRUCTED_H

/* exp(-z) for 0 <= z <= 7, relative error 8e-7: (exp(-z/16))^16 by the series, with terms in pairs
 * to shorten the chain of dependent operations. */
ALWAYS_INLINE double reconstructed_damping(double z)
{
    const double t = -0.0625 * z, t2 = t * t;
    const double low = (1 + t) + t2 * (1. / 2 + t * (1. / 6));
    const double high = (1. / 24 + t * (1. / 120)) + t2 * (1. / 720 + t * (1. / 5040));
    double s = low + t2 * t2 * high;
    s *= s;
    s *= s;
    s *= s;
    return s * s;
}

/* The closing speed is closing/scale, so that the pair needs one division. It is 0 if the pair
 * itself recedes: heating uses v_ij, and viscosity must not cool. */
ALWAYS_INLINE struct viscosity_terms reconstructed_viscous(const struct pair_numbers *numbers,
                                                           const struct pair_side *i,
                                                           const struct pair_side *j,
                                                           const struct viscosity_pair *pair)
{
    const double r = pair->r, near = numbers->near;
    const double sum = i->slope + j->slope, product = i->slope * j->slope;
    const double q = r * least(i->h_inverse, j->h_inverse);
    const double z = q < near ? least((near - q) * 5, 2.6) : 0;
    const double one_sided = product > 0 ? 2 * r * product * reconstructed_damping(z * z) : 0;
    const double scale = product > 0 ? sum : 1;
    const double at_midpoint = pair->closing * scale + one_sided;
    return (struct viscosity_terms){
        .closing = pair->closing > 0 && at_midpoint * scale > 0 ? at_midpoint : 0,
        .scale = scale,
        .alpha_half = 0.5 * numbers->alpha,
        .beta = numbers->beta,
        .c_sum = i->c + j->c,
        .factor = pair->factor};
}

#endif
VISCOSITY(reconstructed,
          .member = {"reconstructed", "velocities extrapolated to the midpoint, limited",
                     "Rosswog 2020"},
          .least_dim = 1, .parameters = "alpha beta viscosity_form balsara", .midpoint = true,
          .defaults = {.cloud_form = VISCOSITY_FORM_SIGNAL, .predicted = PAIR_WIDTH_HARMONIC})
