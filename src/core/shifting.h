/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle shifting with fluxes, in 2D and 3D, CONVENTIONS eqs. 6.14 and 6.15. In a vortex
 * particles become disordered, and the gradient of a constant pressure is then no longer 0:
 * particles move against what the gradient makes of a constant, and exchange the gas that they
 * sweep over. Both vanish as the spacing does. One particle gains the mass, momentum and total
 * energy that the other loses. As the gas has the pair's mean velocity, kinetic and internal energy
 * are each conserved. Uniform velocity and specific energy stay uniform.
 * With shifting=closed the gradients of a pair make less of a constant, eq. 6.16. Disorder then
 * pushes particles less, and their shift alone has to spread them evenly. */
#ifndef SPHPROOF_SHIFTING_H
#define SPHPROOF_SHIFTING_H

#include <math.h>

#include "specialise.h"

#define SHIFTING_PART 9. /* of eta h c E: the shift */

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
        shift[a] = -(eta / SHIFTING_PART) * h * c * of_one[a];
        square += shift[a] * shift[a];
    }
    const double scale = square > most * most ? most / sqrt(square) : 1;
    for (int a = 0; a < dim; a++) shift[a] *= scale;
}

/* E over the shift, so that E needs no field of its own; where the shift is limited, E comes out
 * as small as the shift. near: 1/eta. */
ALWAYS_INLINE double shifting_of_one(double near, double h_inverse, double c)
{
    return -SHIFTING_PART * near * h_inverse / c;
}

/* What is subtracted from a component of a pair's mean gradient; of_one_i and of_one_j are those of
 * E. along: the distance times the gradient, whose sum over j, with V_j, is the dimension. With a
 * larger share than 0.35 fine vortices have larger errors, because forces spread particles less. */
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
