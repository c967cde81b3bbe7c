/* SPDX-License-Identifier: GPL-3.0-or-later
 * How much of a run is skipped, how much could be, and where and when it sleeps. */
#ifndef SPHPROOF_BENCH_POSSIBLE_H
#define SPHPROOF_BENCH_POSSIBLE_H

#include "run.h"

enum { BENCH_ROWS = 32, BENCH_COLUMNS = 64 };

/* Of the particle updates of a run. */
struct bench_shares {
    double skipped;
    /* What could be: particles further than three smoothing lengths ahead of every wave of the
     * exact solution; or, where that has no waves with an edge, particles whose velocity and
     * density change more slowly than a coarse threshold. */
    double possible;
    /* What the promise of sleep allows by whatever rule, from a run without skips: bench_allowed.h;
     * NaN: the run has no tolerance of sleep. */
    double allowed;
    double tolerance; /* of sleep: sleep.h; 0: the run has none */
    bool coarse;      /* possible is found with the coarse threshold */
    /* Of what is possible and was done: particles whose own rates are above the tolerance of sleep,
     * so that a precursor has reached them; and particles that are awake for their neighbours. */
    double reached, layers;
    /* Share of the gas that sleeps, by parts of t_end and parts of the box along x, of which there
     * are so few that none between particles is empty at the start; NaN: no gas. */
    int columns;
    double asleep[BENCH_ROWS][BENCH_COLUMNS];
};

/* Is at least four fifths skipped of what is allowed, but for two in a hundred of all updates? True
 * where nothing tells. */
bool bench_shares_enough(const struct bench_shares *shares);

/* Runs it, with or without skips as its keys say. STATUS_*: as run_execute. */
enum status bench_possible(const struct run *run, struct bench_shares *shares, struct error *error);

#endif
