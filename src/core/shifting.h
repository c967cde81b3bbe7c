/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle shifting with fluxes, in 2D and 3D, CONVENTIONS eqs. 6.14 and 6.15. In a vortex
 * particles become disordered, and the gradient of a constant pressure no longer vanishes.
 * Particles move against the gradient of a constant and exchange the gas that they sweep over; both
 * vanish with the spacing. One particle gains the mass, momentum and total energy that the other
 * loses. As the gas has the pair's mean velocity, kinetic and internal energy are each conserved.
 * Uniform velocity and uniform specific energy stay uniform.
 * With shifting=closed the pair gradients of each particle also add up to 0, eq. 6.16, so that a
 * constant pressure exerts no force (Chiu, Wang, Hu & Jameson 2012; Trask, Bochev & Perego 2020
 * solve for such gradients). The correction of the gradients is antisymmetric: a difference of
 * potentials, which each evaluation improves by one step of Jacobi's iteration. Disorder then
 * exerts no force, so only the shift spreads the particles. */
#ifndef SPHPROOF_SHIFTING_H
#define SPHPROOF_SHIFTING_H

#include <math.h>

#include "specialise.h"

/* Largest length of a potential times h. In shocks and at jumps of the spacing the sum of gradients
 * is not due to disorder, and closing it would change the forces far into the surrounding gas. */
#define SHIFTING_POTENTIAL 0.05
/* Maximum number of evaluations of the first state, whose potentials start at 0. */
#define SHIFTING_START 8

/* Shortens a vector that is longer than `most` to this length. */
ALWAYS_INLINE void shifting_limit(int dim, double most, double *vector)
{
    double square = 0;
    for (int a = 0; a < dim; a++) square += vector[a] * vector[a];
    const double scale = square > most * most ? most / sqrt(square) : 1;
    for (int a = 0; a < dim; a++) vector[a] *= scale;
}

/* Replaces the last shift velocity s by 0.7 s - 0.12 eta h c E, at most c/10; E is the particle's
 * gradient of 1. Keeping part of the last shift (the heavy-ball method) allows a stronger shift
 * before it becomes unstable. With the factor eta this limit is the same number of spacings per
 * step for all smoothing lengths. */
ALWAYS_INLINE void shifting_velocity(int dim, const double *of_one, double eta, double h, double c,
                                     double *shift)
{
    for (int a = 0; a < dim; a++) shift[a] = 0.7 * shift[a] - 0.12 * eta * h * c * of_one[a];
    shifting_limit(dim, 0.1 * c, shift);
}

/* The correction that is subtracted from a component of a pair's mean gradient; phi_i and phi_j are
 * the components of the potentials. along: distance times gradient; its sum over j with V_j is the
 * dimension. */
ALWAYS_INLINE double shifting_closure(int dim, double along, double phi_i, double phi_j)
{
    return along * (phi_i - phi_j) / dim;
}

/* Mass gained by particle i: the volume swept times the donor's density. swept: A . (shift_i +
 * shift_j)/2 with the pair's area vector A, positive if i gains. */
ALWAYS_INLINE double shifting_mass(double swept, double rho_i, double rho_j)
{
    return swept * (swept > 0 ? rho_j : rho_i);
}

/* Energy gained with this mass, at the donor's specific internal energy. v_dot_v: v_i . v_j, twice
 * the specific kinetic energy for which a mass of velocity (v_i + v_j)/2 makes no heat. */
ALWAYS_INLINE double shifting_energy(double mass, double u_i, double u_j, double v_dot_v)
{
    return mass * ((mass > 0 ? u_j : u_i) + 0.5 * v_dot_v);
}

#endif
