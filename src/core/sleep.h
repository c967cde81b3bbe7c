/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles that no signal has reached sleep: on an undisturbed lattice the rates vanish to
 * round-off, so density, forces and time step are skipped there. A sleeping particle keeps its
 * velocity.
 *
 * The disturbance of a particle is |dp/dt| / (tol m c^2/h) or |de/dt| / (tol m c^2 (c + |v|)/h),
 * where c is its sound speed or the setup's mean one c_s, whichever is larger (c_s: all energy
 * except that of the common motion counted as heat); with particle shifting also |shift| / (tol c),
 * because disordered cold gas has hardly any force. In 2D and 3D a sleeping particle wakes when the
 * effect of neighbours with a disturbance above 1 on its rates within a step exceeds 1: the sum of
 * K V h |dW/dr| times their disturbance, as pressure acts in the equation of motion. K = 4 also
 * covers viscosity, matrices and growth within the step. In 1D whole ranges wake around a particle
 * with a disturbance above 1. In every dimension a sleeping particle wakes if a neighbour moves
 * relative to it at more than tol c. A particle that is below a quarter of these limits falls
 * asleep (again).
 *
 * tol is 1e-8 of the largest rate at the start in 2D and 3D, at least 1e-11; in 1D it is 1e-11,
 * because strong fronts amplify any change by 1e7. In weak waves it is smaller in proportion.
 *
 * Effect of the skipped rates until t_end: they are at most about tol c^2/h. Over a time T this
 * changes velocities by tol c (c T/h), and distances, and so densities, by tol (c T/h)^2/2 of h.
 * Ahead of a wave, rates fall by orders of magnitude within one support radius, and they last only
 * about h/c before the gas wakes: then both changes are about tol, in the precursor of the wave
 * only, and means of fields change by 1e-10 to 1e-9 (L1 errors, of 1e-4 and more, by 1e-8 of
 * themselves). With c_s in place of c the changes are relative to the fields that the setup's
 * energy makes, not to a cold gas that a blast will run over. A flow that amplifies round-off
 * amplifies these changes as well: sleep acts like a change of the start by the tolerance.
 *
 * The mass, momentum and energy that sleeping particles lack are distributed among the awake ones
 * (sleep_balance), so that sums are conserved to round-off, but no more than a hundred tolerances
 * of each sleeping particle: a force that is not antisymmetric still shows in the sums.
 *
 * For awake particles, vanishing terms of pairs are skipped as well (plan.quiet):
 * - in 2D and 3D viscosity, if the velocities of all neighbours agree within a hundredth of tol c
 *   and no velocity gradient exceeds this over h, and velocity gradients, if the velocities agree
 *   likewise; not with viscosity=projected, which uses the direction of the smallest gradients, nor
 *   with cullen_dehnen, which uses the sign of the divergence;
 * - in 1D viscosity and velocity gradients of viscosity=reconstructed, in ranges where all pairs
 *   recede: there they are exactly 0.
 * Tried and dropped, because the tests cost as much as they saved: keeping the matrices of
 * particles whose neighbours have not moved, and skipping viscosity with constant alpha in 1D. */
#ifndef SPHPROOF_SLEEP_H
#define SPHPROOF_SLEEP_H

#include <stdbool.h>
#include <stddef.h>

struct simulation;

/* Awake particles first .. first+len-1. */
struct span {
    ptrdiff_t first, len;
};

struct sleep {
    bool on;          /* some particles sleep; spans exclude them */
    bool at_rest;     /* all sleeping particles have zero velocity, so integrators may skip them */
    double rate;      /* largest signal speed / h of the sleeping particles */
    double sound;     /* c_s; 0 before sleep_scale */
    double tolerance; /* tol; 0 before sleep_scale */
    struct span *spans; /* of awake particles; one span of all if none sleeps */
    ptrdiff_t span_count, awake_count;
};

/* Disturbance below which an awake particle may fall asleep. */
#define SLEEP_CALM 0.25

/* True in those steps that look for particles that may fall asleep. */
bool sleep_due(const struct simulation *simulation);

/* Lower bound of the tolerance, above the round-off of a lattice. */
double sleep_least_tolerance(const struct simulation *simulation);

/* Sets sleep.sound and sleep.tolerance from the state and its rates. */
void sleep_scale(struct simulation *simulation);

/* The largest disturbance of these particles; NaN if a rate is NaN. */
double sleep_disturbance(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* Sets the rates of these particles, which fall asleep, to 0. */
void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* Distributes among awake particles the rates that sleeping particles lack, up to the tolerance of
 * each sleeping particle, so that momentum and total energy are conserved to round-off. To be
 * called after the rates have been computed. Where walls or fixed layers absorb momentum or energy,
 * these are not changed. */
void sleep_balance(struct simulation *simulation);

#endif
