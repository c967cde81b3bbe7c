/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles that no signal has reached sleep: on an undisturbed lattice the rates vanish to
 * round-off, so density, forces and time step are left out there. A group of neighbours is awake
 * once a particle within the margin is disturbed, |dp/dt| > tolerance P or |de/dt| > tolerance P c,
 * and stays awake. The tolerance lies above the rounding of the lattice, so results with and
 * without sleep agree to about the tolerance, not to the last bit. */
#ifndef SPHPROOF_SLEEP_H
#define SPHPROOF_SLEEP_H

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

struct simulation;

enum { SLEEP_GROUP = 8 }; /* particles that sleep and wake together */

/* Awake particles first .. first+len-1. */
struct span {
    ptrdiff_t first, len;
};

struct sleep {
    bool on;      /* somebody sleeps */
    bool at_rest; /* all sleepers have no velocity: integrators may leave them out, too */
    double rate;  /* largest signal speed / h of the sleepers */
    ptrdiff_t groups;
    unsigned char *awake; /* of each group */
    double *group_rate;   /* signal speed / h of each group when it fell asleep */
    struct span *spans;   /* of awake particles; all particles where nobody sleeps */
    ptrdiff_t span_count, awake_count;
};

/* After the first rates: finds who may sleep, builds spans and ranges. allowed = false: nobody. */
enum status sleep_begin(struct simulation *simulation, bool allowed, struct error *error);

/* After every step: wakes whom a disturbance comes near. */
void sleep_update(struct simulation *simulation);

/* Everybody wakes (the order has changed). */
void sleep_end(struct simulation *simulation);

void sleep_free(struct sleep *sleep);

#endif
