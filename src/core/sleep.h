/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles that no signal has reached sleep: on an undisturbed lattice the rates vanish to
 * round-off, so density, forces and time step are left out there. A sleeper keeps its velocity.
 *
 * A particle is disturbed once |dp/dt| > tol m c^2/h or |de/dt| > tol m c^2 (c + |v|)/h, where c is
 * its sound speed or the setup's mean one, whichever is more (c_s: all energy but that of the
 * common motion taken for heat). A sleeper wakes when it is a neighbour of a disturbed particle, or
 * of one that moves against it at more than tol c. Whoever is calm, to a quarter of tol, among
 * neighbours that are, falls asleep (again).
 *
 * What the left-out rates could do until t_end: they belong to particles all of whose neighbours
 * are undisturbed, so they are at most about tol c^2/h. Over a time T that changes velocities by
 * tol c (c T/h) and distances, and so densities, by tol (c T/h)^2/2 of h. Rates fall by orders of
 * magnitude from reach to reach ahead of a wave and stand for h/c only before the gas wakes: then
 * both changes are about tol. With c_s for c they are compared with the fields that the setup's
 * energy makes, not with those of a cold gas that a blast will run over. The errors of any run (L1
 * of 1e-4 and more) are seven orders above. A flow that amplifies round-off amplifies this as well:
 * skips act as a change of the start by the tolerance does.
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
    struct span *spans; /* of awake particles; all particles where none sleeps */
    ptrdiff_t span_count, awake_count;
};

/* In units of the tolerance. An active particle below SLEEP_CALM may become inactive. A particle
 * above 1 activates its neighbours, and one above SLEEP_VIOLENT their neighbours as well: within
 * one step no more than 1e-4 of a disturbance travels that far. */
#define SLEEP_CALM    0.25
#define SLEEP_VIOLENT 1e5

/* Whether it is time, now and then, to look for particles that may fall asleep again. */
bool sleep_due(const struct simulation *simulation);

/* Sets sleep.sound from the state. */
void sleep_scale(struct simulation *simulation);

/* The tolerance tol, above the rounding of a lattice. */
double sleep_tolerance(const struct simulation *simulation);

/* The largest rate of these particles, in tolerances; NaN where one is no number. */
double sleep_disturbance(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* They fall asleep: they have no rates any more. */
void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

#endif
