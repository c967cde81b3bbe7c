/* SPDX-License-Identifier: GPL-3.0-or-later
 * Local time steps, steps=local: all particles begin and end a block together; in it each particle
 * takes steps that are shorter by its own power of two. Level b takes 2^b steps in a block. A pair
 * belongs to the finer level of its two particles and is evaluated at the middle of that level's
 * steps, where both particles receive the same impulse and the same energy with opposite signs:
 * momentum and total energy are conserved to round-off for any levels (Pelupessy, Janes & Portegies
 * Zwart 2012 split the Hamiltonian of gravity this way).
 *
 * The middles of two levels never coincide, so that an evaluation is for one level. The particles
 * of that level are active: they have sums over all neighbours, and forces from those that are not
 * on a finer level. A particle of a coarser level receives the impulses of its active neighbours
 * and enters with its predicted state. All steps are those of predicted_midpoint; if all particles
 * are on one level the results are identical to it.
 *
 * A particle's level follows from its pace, the inverse of its Courant time, which is at least half
 * of its fastest neighbour's pace, so that neighbours start at most one level apart. If paces rise
 * or neighbours change inside a block, no two neighbours are evaluated more than two levels apart
 * (steps that differ by 4: Saitoh & Makino 2009): before that, the coarser particle wakes to the
 * level below the finer one's. Its step ends where the step of its new level began, and the pairs
 * that change level are evaluated once more, over the time for which they have given too little or
 * too much, with the same impulse and energy for both particles.
 *
 * While blocks do not pay, steps are the integrator's own, and particles may sleep; in blocks
 * all particles are awake. */
#ifndef SPHPROOF_STEPS_H
#define SPHPROOF_STEPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

struct simulation;

enum {
    STEPS_DEPTH = 5, /* planned levels of a block beyond the first */
    STEPS_SPARE = 3, /* finer levels for particles that need them inside a block */
    STEPS_LEVELS = STEPS_DEPTH + STEPS_SPARE + 1,
    STEPS_APART = 2 /* largest difference of the levels of neighbours at any evaluation */
};

/* Time inside a block in ticks: a step of the finest level has two. */
struct steps_clock {
    int finest;    /* the finest level */
    long now, end; /* ticks */
    double tick;
};

/* Limit of steps.worth: an evaluation of few particles searches and predicts all particles, and
 * finds the surrounding pairs twice. */
#define STEPS_WORTH 0.55

struct steps {
    int depth;        /* finest planned level of the block */
    int level;        /* level being evaluated; -1: all particles */
    double span;      /* length of that level's step */
    uint64_t updates; /* evaluations of active particles in the block */
    uint64_t woken;   /* number of particles woken inside blocks so far */
    int rest;         /* single steps until the next test whether blocks pay */
    bool single;      /* the integrator's own steps are taken, as blocks do not pay */
    double worth;     /* blocks pay if their work is at most this fraction */
    struct steps_clock clock;
};

/* Chooses the depth of the next block, whose finest steps are dt and which is not longer than left,
 * or a single step. Returns its length. */
double steps_begin_block(struct simulation *simulation, double dt, double left);

/* Advances the state by a block of length dt, and sets the time-step limit for the next one. */
enum status steps_block(struct simulation *simulation, double dt, struct error *error);

/* The following functions are for the sums, in the evaluation of a level. */

/* To be called before the density sums of active particles are computed. */
void steps_begin_sums(struct simulation *simulation);

/* The level to which neighbours of active particles wake. */
int steps_woken_level(const struct simulation *simulation);

/* spans: for each coarser level, the time for which its pairs have given too little (< 0: too much)
 * if they change to the level to which particles wake; STEPS_LEVELS values. Returns whether any is
 * not 0. */
bool steps_uncovered(const struct simulation *simulation, double *spans);

/* Wakes particles whose pairs have been corrected, and predicts all particles again; woken: new
 * level of each, 0: stays. STATUS_BROKE_DOWN: a particle has no internal energy. */
enum status steps_wake(struct simulation *simulation, const unsigned char *woken,
                       struct error *error);

#endif
