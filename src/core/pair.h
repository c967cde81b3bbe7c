/* SPDX-License-Identifier: GPL-3.0-or-later
 * The physics of one pair of particles, for every dimension. The geometry is given by scalars:
 *
 *   r        distance |x_i - x_j|
 *   closing  -v_ij . e_ij with e_ij = (x_i - x_j)/r: positive if the pair approaches
 *   G        size of the pair gradient. If grad_i W = -G e_ij (standard; in 1D also ia, where
 *            G > 0 as well) the terms below are forces along e_ij. If the gradient has a direction
 *            of its own (ia in 2D and 3D), pass 1 and multiply by the vector.
 *
 * Terms are returned as a_i, a_j, the contribution of each particle to the pair,
 *   m_i dv_i/dt = sum_j (a_i + a_j) e_ij,   dU_i/dt = sum_j a_i closing,
 * so that forces are antisymmetric and lost kinetic energy becomes heat. */
#ifndef SPHPROOF_PAIR_H
#define SPHPROOF_PAIR_H

#include <math.h>
#include <stdbool.h>

#include "scheme.h"
#include "specialise.h"
#include "viscosity.h"

struct pair_terms {
    double i, j;
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

/* The pressure term of a formulation; vanilla_ice uses only G_i. */
ALWAYS_INLINE struct pair_terms pair_pressure(enum formulation formulation,
                                              const struct pair_side *i, const struct pair_side *j,
                                              double G_i, double G_j)
{
    switch (formulation) { /* without default, so that a missing member is a compile-time error */
    case FORMULATION_VANILLA_ICE:
        return pair_pressure_vanilla_ice(i, j, G_i);
    case FORMULATION_LAGRANGIAN:
        return pair_pressure_lagrangian(i, j, G_i, G_j);
    }
    return (struct pair_terms){0, 0};
}

/* --- viscosity -------------------------------------------------------------------------------- */

/* hbar = (h_i + h_j)/4 = over/under: computed from 1/h without a division. */
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

/* The term m_i m_j PI G/2 that viscosity adds to both a_i and a_j (each particle gets half of the
 * heat), in the form of Monaghan 1992, CONVENTIONS eqs. 5.6 to 5.8: PI = (-alpha cbar mu + beta
 * mu^2)/rhobar, mu = -hbar closing r/(r^2 + 0.01 hbar^2), hbar = (h_i + h_j)/4; 0 if the pair
 * recedes. G: mean of both gradients. */
ALWAYS_INLINE double pair_viscous(struct viscosity_terms terms, const struct pair_side *i,
                                  const struct pair_side *j, struct pair_mean_width h_bar, double r,
                                  double G)
{
    /* mu = -t under/D2. cbar and rhobar are half sums: one half is in alpha_half, and the sum of
     * the densities absorbs the 1/2 of the heating. */
    const double over = h_bar.over, under = h_bar.under, t = over * r * terms.closing;
    const double D2 = (r * r * (under * under) + 0.01 * (over * over)) * terms.scale;
    return i->m * j->m * G * t * (terms.alpha_half * terms.c_sum * D2 + terms.beta * t * under) *
           under / (D2 * D2 * (i->rho + j->rho));
}

/* The same term with the signal velocity (Monaghan 1997, CONVENTIONS eq. 6.2), for closing = -w_ij
 * > 0: PI = (alpha cbar + (beta/2) closing) closing/rhobar. midpoint: scale differs from 1. */
ALWAYS_INLINE double pair_viscous_signal(bool midpoint, struct viscosity_terms terms,
                                         const struct pair_side *i, const struct pair_side *j,
                                         double G)
{
    /* one division for both quotients, by the scale and by the densities */
    const double rho_sum = i->rho + j->rho, inverse = 1 / (terms.scale * rho_sum);
    const double speed = midpoint ? terms.closing * rho_sum * inverse : terms.closing;
    return i->m * j->m * G * speed * (terms.alpha_half * terms.c_sum + 0.5 * terms.beta * speed) *
           (terms.scale * inverse);
}

/* --- energy ----------------------------------------------------------------------------------- */

/* Heating of both particles, CONVENTIONS eqs. 5.2 and 5.4: dU_i/dt = sum_j a_i closing (a_i = f_i
 * P_i V_i V_j G plus half of the viscosity). */
ALWAYS_INLINE struct pair_terms pair_heating(struct pair_terms a, double closing)
{
    return (struct pair_terms){a.i * closing, a.j * closing};
}

/* Flux of total energy from i to j along one axis, CONVENTIONS eq. 5.5 (v_i, v_j: velocities along
 * it, a: terms along it): the pressure of each particle times the velocity of the other, so that
 * dE_i = -dE_j = v_i . dp_i + dU_i. */
ALWAYS_INLINE double pair_energy_flux(struct pair_terms a, double v_i, double v_j)
{
    return a.j * v_i + a.i * v_j;
}

/* --- time step -------------------------------------------------------------------------------- */

/* True if r is inside the larger of two supports, with the smoothing lengths of the sums. The
 * neighbour search uses the same, so it finds every pair that counts. */
ALWAYS_INLINE bool pair_within(double r, double h_inverse_i, double h_inverse_j)
{
    return r * least(h_inverse_i, h_inverse_j) < 1;
}

/* Signal speed, CONVENTIONS eq. 5.14 (Monaghan 1997; Springel 2005). */
ALWAYS_INLINE double pair_signal_speed(double c_i, double c_j, double closing)
{
    return c_i + c_j + 3 * largest(closing, 0);
}

/* --- conductivity ----------------------------------------------------------------------------- */

/* CONVENTIONS eq. 6.8: (alpha_u + alpha_s min(1, max(0, (5 D - 1)/2))) v_u/rhobar. */
ALWAYS_INLINE double pair_conduction(double alpha_u, double alpha_s, double P_i, double P_j,
                                     double rho_bar)
{
    const double jump = fabs(P_i - P_j), sum = fabs(P_i) + fabs(P_j), scale = sum > 0 ? sum : 1;
    /* one division for both */
    const double inverse = 1 / (rho_bar * scale), per_rho = inverse * scale,
                 shock = largest(2.5 * jump * inverse * rho_bar - 0.5, 0);
    return (alpha_u + alpha_s * least(shock, 1)) * sqrt(jump * per_rho) * per_rho;
}

/* True if alpha_s may act on this pair, with a margin for round-off; otherwise its term is exactly
 * 0. */
ALWAYS_INLINE bool pair_shocked(double P_i, double P_j)
{
    return 5 * fabs(P_i - P_j) > 0.999 * (fabs(P_i) + fabs(P_j));
}

#endif
