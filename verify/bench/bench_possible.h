/* SPDX-License-Identifier: GPL-3.0-or-later
 * How much of a run is skipped, and how much could be: particles further than three smoothing
 * lengths ahead of every wave of the exact solution. */
#ifndef SPHPROOF_BENCH_POSSIBLE_H
#define SPHPROOF_BENCH_POSSIBLE_H

#include "run.h"

/* Of the particle updates of a run. */
struct bench_shares {
    double skipped;
    double possible; /* NaN: the exact solution has no waves with an edge */
};

/* Runs it, with or without skips as its keys say. STATUS_*: as run_execute. */
enum status bench_possible(const struct run *run, struct bench_shares *shares, struct error *error);

#endif
