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
 * its fastest neighbour's pace, so that neighbours start one level apart at most. Where paces rise
 * or neighbours change inside a block, no two of them are evaluated more than two levels apart
 * (steps that differ by 4: Saitoh & Makino 2009): before that, the coarser one wakes to the level
 * below the finer one's. Its step ends where that of its new level has begun, and the pairs that
 * change levels are evaluated once more, over the time that they have been given too little or too
 * much, with the same impulse and energy for both sides.
 *
 * While blocks do not pay, steps are the integrator's own, and particles may sleep; in blocks all
 * are awake. */
#ifndef SPHPROOF_STEPS_H
#define SPHPROOF_STEPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

struct simulation;

enum {
    STEPS_DEPTH = 5, /* levels of a block beyond the first that are planned */
    STEPS_SPARE = 3, /* and those that particles may flee to when a block has begun */
    STEPS_LEVELS = STEPS_DEPTH + STEPS_SPARE + 1,
    STEPS_APART = 2 /* levels of neighbours differ by no more at any evaluation */
};

/* Time inside a block in ticks, two of which are a step of the finest level of all. */
struct steps_clock {
    int finest;    /* that level */
    long now, end; /* ticks */
    double tick;
};

/* Evaluations of few particles search and predict for all, and find the pairs beside them twice. */
#define STEPS_WORTH 0.55

struct steps {
    int depth;        /* the finest planned level of the block */
    int level;        /* being evaluated; -1: all particles are */
    double span;      /* step of that level */
    uint64_t updates; /* of active particles in the block */
    uint64_t woken;   /* particles inside blocks, so far */
    int rest;         /* single steps before the next look at whether blocks pay */
    bool single;      /* the integrator's own steps, as with steps=global: blocks do not pay */
    double worth;     /* blocks pay where no more than this part of the work is left */
    struct steps_clock clock;
};

/* The length of the block that begins with finest steps of dt, no longer than what is left. Chooses
 * its depth, or a single step. */
double steps_begin_block(struct simulation *simulation, double dt, double left);

/* Advances the state by the block, and sets the time-step limit for the next one. */
enum status steps_block(struct simulation *simulation, double dt, struct error *error);

/* What the sums ask for in the evaluation of a level. */

/* The density sums of active particles are about to be found anew. */
void steps_begin_sums(struct simulation *simulation);

/* The level that neighbours of active particles wake to. */
int steps_woken_level(const struct simulation *simulation);

/* What pairs of each coarser level have been given too little of (< 0: too much) if they go over to
 * the level that particles wake to. Returns whether there is any. spans: STEPS_LEVELS. */
bool steps_uncovered(const struct simulation *simulation, double *spans);

/* Wakes particles whose pairs have been corrected, and predicts all anew; woken: the level that
 * each goes to, 0: none. STATUS_BROKE_DOWN: one has no internal energy. */
enum status steps_wake(struct simulation *simulation, const unsigned char *woken,
                       struct error *error);

#endif
