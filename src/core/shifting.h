/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particle shifting with fluxes, in 2D and 3D, CONVENTIONS eqs. 6.14 and 6.15. In a vortex
 * particles become disordered, and the gradient of a constant pressure is then no longer 0:
 * particles move against what the gradient makes of a constant, and exchange the gas that they
 * sweep over. Both vanish as the spacing does. One particle gains the mass, momentum and total
 * energy that the other loses. As the gas has the pair's mean velocity, kinetic and internal energy
 * are each conserved. Uniform velocity and specific energy stay uniform.
 * With shifting=closed the gradients of all pairs of a particle also add up to 0, eq. 6.16, so that
 * a constant pressure exerts no force (Chiu, Wang, Hu & Jameson 2012; Trask, Bochev & Perego 2020
 * solve for such gradients). Their correction is antisymmetric: a difference of potentials, of
 * which each evaluation makes one more step of Jacobi's iteration. Only their shift spreads
 * particles then, as disorder does not push them. */
#ifndef SPHPROOF_SHIFTING_H
#define SPHPROOF_SHIFTING_H

#include <math.h>

#include "specialise.h"

/* The longest potential, times h. In shocks and where spacings jump, gradients add up to something
 * that is no disorder, and to close them would change the forces far into the gas around. */
#define SHIFTING_POTENTIAL 0.05
/* Evaluations of the first state, which has no potentials yet. */
#define SHIFTING_START 8

/* Shortens a vector to this length at most. */
ALWAYS_INLINE void shifting_limit(int dim, double most, double *vector)
{
    double square = 0;
    for (int a = 0; a < dim; a++) square += vector[a] * vector[a];
    const double scale = square > most * most ? most / sqrt(square) : 1;
    for (int a = 0; a < dim; a++) vector[a] *= scale;
}

/* The velocity relative to the flow, 0.7 s - 0.12 eta h c E, at most c/10, in place of the last
 * evaluation's s; E is what the particle's gradient makes of 1. A shift that
 * remembers the last one (the heavy-ball method of iterations) may be stronger before it becomes
 * unstable. The factor eta makes that limit, a number of spacings in a step, the same for all
 * widths. */
ALWAYS_INLINE void shifting_velocity(int dim, const double *of_one, double eta, double h, double c,
                                     double *shift)
{
    for (int a = 0; a < dim; a++) shift[a] = 0.7 * shift[a] - 0.12 * eta * h * c * of_one[a];
    shifting_limit(dim, 0.1 * c, shift);
}

/* What is subtracted from a component of a pair's mean gradient; phi_i and phi_j are those of the
 * potential. along: the distance times the gradient, whose sum over j, with V_j, is the
 * dimension. */
ALWAYS_INLINE double shifting_closure(int dim, double along, double phi_i, double phi_j)
{
    return along * (phi_i - phi_j) / dim;
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
