/* SPDX-License-Identifier: GPL-3.0-or-later
 * The physics of one pair of particles, for every dimension. Geometry comes in as scalars:
 *
 *   r        distance |x_i - x_j|
 *   closing  -v_ij . e_ij with e_ij = (x_i - x_j)/r: positive where the pair approaches
 *   G        size of the pair gradient. With the gradient in use grad_i W = -G e_ij (standard; in
 *            1D also ia, where G > 0 as well) the terms below are forces along e_ij. Where the
 *            gradient is a vector of its own (ia in 2D and 3D), pass 1 and multiply by the vector.
 *
 * Terms come as a_i, a_j: what either particle contributes to the pair,
 *   m_i dv_i/dt = sum_j (a_i + a_j) e_ij,   dU_i/dt = sum_j a_i closing,
 * so that forces are antisymmetric and what leaves the kinetic energy arrives as heat. */
#ifndef SPHPROOF_PAIR_H
#define SPHPROOF_PAIR_H

#include <stdbool.h>

#include "scheme.h"
#include "specialise.h"

/* What one particle brings into a pair; a term reads what it needs, and what none reads costs
 * nothing, as everything here is inlined. */
struct pair_side {
    double m, Z;      /* mass; what the density sum adds up: m, or U with the energy element */
    double V;         /* volume Z/y */
    double h_inverse; /* 1/h */
    double P, rho, c; /* pressure, density of the equation of state, sound speed */
    double alpha;     /* viscosity of the particle: time_dependent */
    double b, grad_h; /* lagrangian: Z P/y^2 and 1 - f */
    double slope;     /* reconstructed: e . (grad v) e along the pair; in 1D dv/dx */
};

struct pair_terms {
    double i, j;
};

/* The numbers of the viscosity, the same for all pairs. */
struct pair_numbers {
    double alpha, beta; /* not of time_dependent */
    double beta_ratio;  /* time_dependent: beta/alpha, alpha the mean of the pair */
    double near;        /* reconstructed: 1/eta, pairs closer than near * h are damped */
};

/* --- pressure --------------------------------------------------------------------------------- */

/* vanilla_ice, CONVENTIONS eq. 5.1 (Wadsley, Keller & Quinn 2017, lambda = 1):
 * m_i dv_i/dt = -sum_j Z_i Z_j (P_i + P_j)/(y_i y_j) Gbar_ij, and Z/y = V. G: mean of both. */
ALWAYS_INLINE struct pair_terms pair_pressure_vanilla_ice(const struct pair_side *i,
                                                          const struct pair_side *j, double G)
{
    const double A = i->V * j->V * G;
    return (struct pair_terms){A * i->P, A * j->P};
}

/* lagrangian, CONVENTIONS eq. 5.3 (Springel & Hernquist 2002; f_ij of Hopkins 2013):
 * m_i dv_i/dt = -sum_j Z_i Z_j (f_ij P_i/y_i^2 G_ij(h_i) + f_ji P_j/y_j^2 G_ij(h_j)) with
 * f_ij = 1 - (m_j/Z_j)(1 - f_i), b = Z P/y^2. */
ALWAYS_INLINE struct pair_terms pair_pressure_lagrangian(const struct pair_side *i,
                                                         const struct pair_side *j, double G_i,
                                                         double G_j)
{
    return (struct pair_terms){i->b * (j->Z - j->m * i->grad_h) * G_i,
                               j->b * (i->Z - i->m * j->grad_h) * G_j};
}

/* Either of them; vanilla_ice has one gradient, G_i. */
ALWAYS_INLINE struct pair_terms pair_pressure(enum formulation formulation,
                                              const struct pair_side *i, const struct pair_side *j,
                                              double G_i, double G_j)
{
    switch (formulation) { /* every member of the list: another one does not compile without */
    case FORMULATION_VANILLA_ICE:
        return pair_pressure_vanilla_ice(i, j, G_i);
    case FORMULATION_LAGRANGIAN:
        return pair_pressure_lagrangian(i, j, G_i, G_j);
    }
    return (struct pair_terms){0, 0};
}

/* --- viscosity -------------------------------------------------------------------------------- */

/* exp(-z) for 0 <= z <= 7, to 8e-7 relative: (exp(-z/16))^16 by the series, in pairs of terms, as
 * the length of the chain of operations is what costs. */
ALWAYS_INLINE double pair_damping(double z)
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

/* Closing speed of a pair extrapolated to its midpoint with a limited slope, CONVENTIONS eqs. 5.11
 * and 5.12 (Frontiere, Raskin & Owen 2017; Rosswog 2020, eqs. 18-22): closing + phi/2 (s_i + s_j)
 * r, phi = max(0, 4 s_i s_j/(s_i + s_j)^2) exp(-((q - near)/0.2)^2 where q = r/max(h_i, h_j) <
 * near). Returned as a numerator over *scale, so that the pair needs one division. Zero where the
 * pair itself recedes: the heating uses v_ij, and viscosity never cools. */
ALWAYS_INLINE double pair_closing_at_midpoint(const struct pair_side *i, const struct pair_side *j,
                                              double r, double closing, double near, double *scale)
{
    const double sum = i->slope + j->slope, product = i->slope * j->slope;
    const double q = r * least(i->h_inverse, j->h_inverse);
    const double z = q < near ? least((near - q) * 5, 2.6) : 0;
    const double one_sided = product > 0 ? 2 * r * product * pair_damping(z * z) : 0;
    *scale = product > 0 ? sum : 1;
    const double at_midpoint = closing * *scale + one_sided;
    return closing > 0 && at_midpoint * *scale > 0 ? at_midpoint : 0;
}

/* Viscosity fading, CONVENTIONS eq. 5.13: the linear term sees the speed of sound only where a pair
 * closes faster than this part of it, and a proportionally smaller one below: smooth flow is left
 * alone, to second order, while shocks (0.1 c and more a pair) do not notice. */
static const double pair_fade_below = 0.01;

/* What tells a viscosity's pair term from the plain one. Every member of the list has its place
 * here: another one does not compile without. */
struct pair_form {
    bool midpoint, varying, fading;
};

ALWAYS_INLINE struct pair_form pair_form_of(enum viscosity viscosity)
{
    switch (viscosity) {
    case VISCOSITY_NONE:
    case VISCOSITY_CONSTANT:
        return (struct pair_form){0};
    case VISCOSITY_TIME_DEPENDENT:
    case VISCOSITY_CULLEN_DEHNEN:
        return (struct pair_form){.varying = true};
    case VISCOSITY_RECONSTRUCTED:
    case VISCOSITY_PROJECTED: /* its shock term */
        return (struct pair_form){.midpoint = true};
    case VISCOSITY_FADING:
        return (struct pair_form){.fading = true};
    }
    return (struct pair_form){0};
}

/* hbar = (h_i + h_j)/4 as a quotient: who has only 1/h needs no division for it. */
struct pair_mean_width {
    double over, under;
};

ALWAYS_INLINE struct pair_mean_width pair_mean_width(double h_i, double h_j)
{
    return (struct pair_mean_width){0.25 * (h_i + h_j), 1};
}

ALWAYS_INLINE struct pair_mean_width pair_mean_width_inverse(double h_inverse_i, double h_inverse_j)
{
    return (struct pair_mean_width){h_inverse_i + h_inverse_j, 4 * (h_inverse_i * h_inverse_j)};
}

/* The term m_i m_j PI G/2 that viscosity adds to a_i and to a_j alike (heat in halves), in the form
 * of Monaghan 1992, CONVENTIONS eqs. 5.6 to 5.8: PI = (-alpha cbar mu + beta mu^2)/rhobar, mu =
 * -hbar closing r/(r^2 + 0.01 hbar^2), hbar = (h_i + h_j)/4, 0 where the pair recedes. G: mean of
 * both gradients. */
ALWAYS_INLINE double pair_viscous(enum viscosity viscosity, const struct pair_numbers *numbers,
                                  const struct pair_side *i, const struct pair_side *j,
                                  struct pair_mean_width h_bar, double r, double closing, double G)
{
    const struct pair_form form = pair_form_of(viscosity);
    double scale = 1;
    const double w = form.midpoint
                         ? pair_closing_at_midpoint(i, j, r, closing, numbers->near, &scale)
                         : largest(closing, 0);
    /* mu = -t under/D2; cbar and rhobar are halves of sums: alpha_half goes with the sum of c, and
     * the 1/2 of the heating with the sum of rho */
    const double over = h_bar.over, under = h_bar.under, c_sum = i->c + j->c;
    const double t = over * r * w, D2 = (r * r * (under * under) + 0.01 * (over * over)) * scale;
    const double alpha_half = form.varying ? 0.25 * (i->alpha + j->alpha) : 0.5 * numbers->alpha;
    const double beta = form.varying ? 2 * numbers->beta_ratio * alpha_half : numbers->beta;
    const double c_seen = form.fading ? least(c_sum, w * (2 / pair_fade_below)) : c_sum;
    return i->m * j->m * G * t * (alpha_half * c_seen * D2 + beta * t * under) * under /
           (D2 * D2 * (i->rho + j->rho));
}

/* The same term with the signal velocity (Monaghan 1997, CONVENTIONS eq. 6.2), for closing = -w_ij
 * > 0: PI = (alpha cbar + (beta/2) closing) closing/rhobar. */
ALWAYS_INLINE double pair_viscous_signal(enum viscosity viscosity,
                                         const struct pair_numbers *numbers,
                                         const struct pair_side *i, const struct pair_side *j,
                                         double r, double closing, double G)
{
    const struct pair_form form = pair_form_of(viscosity);
    double scale = 1;
    const double w = form.midpoint
                         ? pair_closing_at_midpoint(i, j, r, closing, numbers->near, &scale)
                         : largest(closing, 0);
    /* one division for both quotients, by the scale and by the densities */
    const double rho_sum = i->rho + j->rho, inverse = 1 / (scale * rho_sum), c_sum = i->c + j->c;
    const double speed = form.midpoint ? w * rho_sum * inverse : w;
    const double alpha_half = form.varying ? 0.25 * (i->alpha + j->alpha) : 0.5 * numbers->alpha;
    const double beta = form.varying ? 2 * numbers->beta_ratio * alpha_half : numbers->beta;
    const double c_seen = form.fading ? least(c_sum, speed * (2 / pair_fade_below)) : c_sum;
    return i->m * j->m * G * speed * (alpha_half * c_seen + 0.5 * beta * speed) * (scale * inverse);
}

/* --- energy ----------------------------------------------------------------------------------- */

/* Heating of either particle, CONVENTIONS eqs. 5.2 and 5.4: dU_i/dt = sum_j a_i closing (a_i = f_i
 * P_i V_i V_j G and half of the viscosity). */
ALWAYS_INLINE struct pair_terms pair_heating(struct pair_terms a, double closing)
{
    return (struct pair_terms){a.i * closing, a.j * closing};
}

/* Total energy that passes from i to j along one axis, CONVENTIONS eq. 5.5 (v_i, v_j: velocities
 * along it, a: terms along it): the pressure of each with the velocity of the other, so that dE_i =
 * -dE_j = v_i . dp_i + dU_i. */
ALWAYS_INLINE double pair_energy_flux(struct pair_terms a, double v_i, double v_j)
{
    return a.j * v_i + a.i * v_j;
}

/* --- time step -------------------------------------------------------------------------------- */

/* Is a distance r inside the wider of two supports? By the widths that sums are taken at (1/h):
 * neighbours are looked for within those, so that every pair that counts is found. */
ALWAYS_INLINE bool pair_within(double r, double h_inverse_i, double h_inverse_j)
{
    return r * least(h_inverse_i, h_inverse_j) < 1;
}

/* Signal speed, CONVENTIONS eq. 5.14 (Monaghan 1997; Springel 2005). */
ALWAYS_INLINE double pair_signal_speed(double c_i, double c_j, double closing)
{
    return c_i + c_j + 3 * largest(closing, 0);
}

#endif
