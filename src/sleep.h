/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles that no signal has reached sleep: on an undisturbed lattice the rates vanish to
 * round-off, so density, forces and time step are left out there. A group of neighbours is awake
 * once a particle within the margin is disturbed, |dp/dt| > tolerance P h^(d-1) or |de/dt| >
 * tolerance P c h^(d-1), and stays awake. The tolerance lies above the rounding of the lattice, so
 * results with and without sleep agree to about the tolerance, not to the last bit. Which
 * particles form a group and how far a margin is, the sums know (sums.h). */
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
    bool on;            /* somebody sleeps */
    bool at_rest;       /* all sleepers have no velocity: integrators may leave them out, too */
    double rate;        /* largest signal speed / h of the sleepers */
    struct span *spans; /* of awake particles; all particles where nobody sleeps */
    ptrdiff_t span_count, awake_count;
};

/* Has a signal reached any of these particles? */
bool sleep_disturbed(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

/* They fall asleep: they have no rates any more. */
void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len);

#endif
