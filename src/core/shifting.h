/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle shifting with fluxes, in 2D and 3D, CONVENTIONS eqs. 6.14 and 6.15. In a vortex
 * particles become disordered, and the gradient of a constant pressure is then no longer 0:
 * particles move against what the gradient makes of a constant, and exchange the gas that they
 * sweep over. Both vanish as the spacing does. One particle gains the mass, momentum and total
 * energy that the other loses. As the gas has the pair's mean velocity, kinetic and internal energy
 * are each conserved. Uniform velocity and specific energy stay uniform.
 * shifting=closed takes from the pair's area vector what makes gradients of constants, eq. 6.16: as
 * particles shift, order need not come from forces. */
#ifndef SPHPROOF_SHIFTING_H
#define SPHPROOF_SHIFTING_H

#include <math.h>

#include "specialise.h"

/* The velocity relative to the flow, -eta h c E/9, at most c/4; E is what the particle's gradient
 * makes of 1. A shift that is a quarter longer is unstable in fine vortices at the longest steps of
 * predicted_midpoint, which are a number of spacings; the factor eta makes that limit the same for
 * all widths. */
ALWAYS_INLINE void shifting_velocity(int dim, const double *of_one, double eta, double h, double c,
                                     double *shift)
{
    const double most = 0.25 * c;
    double square = 0;
    for (int a = 0; a < dim; a++) {
        shift[a] = -(eta / 9) * h * c * of_one[a];
        square += shift[a] * shift[a];
    }
    const double scale = square > most * most ? most / sqrt(square) : 1;
    for (int a = 0; a < dim; a++) shift[a] *= scale;
}

/* Times the shift: what the gradient makes of 1, as far as the shift shows it; near: 1/eta. */
ALWAYS_INLINE double shifting_of_one(double near, double h_inverse, double c)
{
    return -9 * near * h_inverse / c;
}

/* What to take from a pair's mean gradient, `along` its x . gradient, which times V_j adds up to
 * the dimension. With more of E than this the finest vortices get worse: forces no longer keep
 * order, and shifts alone must. */
ALWAYS_INLINE double shifting_closure(int dim, double along, double of_one_i, double of_one_j)
{
    return 0.35 / dim * along * (of_one_i - of_one_j);
}

/* What particle i gains: the volume that it sweeps over for j has the donor's density and specific
 * energy. swept: A . (shift_i + shift_j)/2 with A the pair's area vector, positive if i gains. */
ALWAYS_INLINE double shifting_mass(double swept, double rho_i, double rho_j)
{
    return swept * (swept > 0 ? rho_j : rho_i);
}

/* v_dot_v: v_i . v_j, which is twice the kinetic energy that mass of velocity (v_i + v_j)/2 carries
 * if none is to become heat. */
ALWAYS_INLINE double shifting_energy(double mass, double u_i, double u_j, double v_dot_v)
{
    return mass * ((mass > 0 ? u_j : u_i) + 0.5 * v_dot_v);
}

#endif
