/* SPDX-License-Identifier: GPL-3.0-or-later
 * Local time steps, steps=local: each particle has a step of its own, a power of two shorter than
 * that of the block that all particles begin and end together. Level b takes 2^b steps in a block.
 * A pair belongs to the finer level of its two particles and is evaluated at the middle of that
 * level's steps, where both particles receive the same impulse and the same energy with opposite
 * signs: momentum and total energy are conserved to round-off, whatever the levels are
 * (Pelupessy, Janes & Portegies Zwart 2012 split the Hamiltonian of gravity so).
 *
 * The middles of two levels never coincide, so that an evaluation serves one level. A particle of
 * that level is active: it has sums over all of its neighbours, and forces of those that are not on
 * a finer level. A particle of a coarser level receives the impulses of its active neighbours
 * and takes part with its predicted state. All steps are those of predicted_midpoint; with all
 * particles on one level they are so to the last bit.
 *
 * A particle's level follows from its pace, the inverse of its Courant time. It is at least half of
 * its fastest neighbour's pace, so that neighbours differ by one level (Saitoh & Makino 2009). */
#ifndef SPHPROOF_STEPS_H
#define SPHPROOF_STEPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

struct simulation;

enum {
    STEPS_DEPTH = 5, /* levels of a block beyond the first that are planned */
    STEPS_SPARE = 3  /* and those that particles may flee to when a block has begun */
};

struct steps {
    int depth;        /* the finest planned level of the block */
    int level;        /* being evaluated; -1: all particles are */
    double span;      /* step of that level */
    uint64_t updates; /* of active particles in the block */
};

/* The length of the block that begins with finest steps of dt, no longer than what is left. Chooses
 * all levels. */
double steps_begin_block(struct simulation *simulation, double dt, double left);

/* Advances the state by the block, and sets the time-step limit for the next one. */
enum status steps_block(struct simulation *simulation, double dt, struct error *error);

#endif
