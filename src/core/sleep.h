/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles that no signal has reached sleep: on an undisturbed lattice the rates vanish to
 * round-off, so density, forces and time step are left out there. A sleeper keeps its velocity.
 *
 * A particle is disturbed by |dp/dt| / (tol m c^2/h) or |de/dt| / (tol m c^2 (c + |v|)/h), where c
 * is its sound speed or the setup's mean one, whichever is more (c_s: all energy but that of the
 * common motion taken for heat); with particle shifting by |shift| / (tol c) as well, as cold gas
 * in disorder feels hardly any force. In 2D and 3D a sleeper wakes when what neighbours disturbed
 * by more than 1 make of its rates in a step comes to more than 1: the sum of K V h |dW/dr| times
 * their disturbance, as pressure acts in the equation of motion. K = 4 stands for viscosity,
 * matrices and growth within the step as well. In 1D whole ranges wake around a particle disturbed
 * by more than 1. Everywhere a sleeper wakes for a neighbour that moves against it at more than
 * tol c. A particle that is calm, to a quarter of these limits, falls asleep (again).
 *
 * tol is 1e-8 of the largest rate at the start in 2D and 3D, at least 1e-11, but 1e-11 in 1D, where
 * strong fronts amplify any change by 1e7. In weak waves it is smaller in proportion.
 *
 * What the left-out rates could do until t_end: they are at most about tol c^2/h. Over a time T
 * that changes velocities by tol c (c T/h) and distances, and so densities, by tol (c T/h)^2/2 of
 * h. Rates fall by orders of magnitude from reach to reach ahead of a wave and stand for h/c only
 * before the gas wakes: then both changes are about tol, of the part of the gas that is a
 * precursor, and means of fields change by 1e-10 to 1e-9 (errors L1, of 1e-4 and more, by 1e-8 of
 * themselves). With c_s for c they are compared with the fields that the setup's energy makes, not
 * with those of a cold gas that a blast will run over. A flow that amplifies round-off amplifies
 * this as well: skips act as a change of the start by the tolerance does.
 *
 * Mass, momentum and energy that sleepers do not get are shared out among those awake
 * (sleep_balance), so that sums stay to round-off, but no more than the tolerance of each sleeper:
 * a force that is not antisymmetric still shows in the sums.
 *
 * Of particles that are awake, what vanishes of their pairs is left out, too (plan.quiet):
 * - in 2D and 3D viscosity, where all neighbours move with the particle to a hundredth of tol c and
 *   have no velocity gradients above that over h, and velocity gradients, where they move together
 *   like this; not of viscosity=projected, whose direction the smallest gradient has, nor of
 *   cullen_dehnen, which sees the sign of a divergence;
 * - in 1D viscosity and velocity gradients of viscosity=reconstructed, in ranges all of whose pairs
 *   recede: there they are exactly 0.
 * Tried and dropped, as looking cost as much as was saved: keeping the matrices of particles whose
 * neighbours have not moved, and leaving out viscosity of constant alpha in 1D.
 */
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
    bool on;            /* some particles sleep, and spans leave them out */
    bool at_rest;       /* all sleepers have no velocity: integrators may leave them out, too */
    double rate;        /* largest signal speed / h of the sleepers */
    double sound;       /* c_s; 0 before sleep_scale */
    double tolerance;   /* tol; likewise */
    struct span *spans; /* of awake particles; all particles where none sleeps */
    ptrdiff_t span_count, awake_count;
};

/* In units of the tolerance: an active particle below it may become inactive. */
#define SLEEP_CALM 0.25

/* Whether it is time, now and then, to look for particles that may fall asleep again. */
bool sleep_due(const struct simulation *simulation);

/* The least tolerance there is, above the rounding of a lattice. */
double sleep_least_tolerance(const struct simulation *simulation);

/* Sets sleep.sound and sleep.tolerance from the state and its rates. */
void sleep_scale(struct simulation *simulation);

/* The largest rate of these particles, in tolerances; NaN where one is no number. */
double sleep_disturbance(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* They fall asleep: they have no rates any more. */
void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* After the rates of a state have been found: shares out among those awake what sleepers do not
 * get, up to the tolerance of each sleeper, so that momentum and total energy stay to round-off.
 * Where walls or fixed layers take momentum or energy, too, these are left alone. */
void sleep_balance(struct simulation *simulation);

#endif
