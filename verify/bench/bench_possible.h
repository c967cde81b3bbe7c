/* SPDX-License-Identifier: GPL-3.0-or-later
 * Computes which fraction of a run is or could be skipped, and where and when gas is inactive. */
#pragma once

#include "initial.h"
#include "run.h"

enum { BENCH_ROWS = 32, BENCH_COLUMNS = 64 };

/* Fractions of the particle updates of a run. */
struct bench_shares {
    double skipped;
    /* Could be skipped: particles more than three smoothing lengths ahead of every wave of the
     * exact solution; if it has no waves with an edge, particles whose velocity and density change
     * more slowly than a coarse threshold. */
    double possible;
    /* Allowed by the promise of sleep under any rule, from a run without skips: bench_allowed();
     * NaN: the run has no tolerance of sleep. */
    double allowed;
    double tolerance; /* of sleep: sleep.h; 0: the run has none */
    bool coarse;      /* possible is found with the coarse threshold */
    /* Possible but not skipped: particles with rates above the tolerance of sleep, which a
     * precursor has reached; and particles that are active because of their neighbours. */
    double reached, layers;
    double spacing; /* 1D: mean spacing over the length of the box; 2D and 3D: 0 */
    /* Sleeping fraction of the gas, in intervals of t_end and of the box along x; the columns are
     * few enough that none between particles is empty at the start. NaN: no gas. */
    int columns;
    double asleep[BENCH_ROWS][BENCH_COLUMNS];
};

/* True if at least four fifths of the allowed work is skipped, apart from 2 % of all updates and,
 * with few particles, from layers; also if nothing is known. */
bool bench_shares_enough(const struct bench_shares *shares);

/* Runs it, with or without skips according to its keys. STATUS_*: as run_execute. */
enum status bench_possible(const struct run *run, struct bench_shares *shares, struct error *error);

/* Runs it without skips. *share: the part of all particle updates after which velocity, density and
 * internal energy of the particle and of all its neighbours are those of the start, to a tolerance
 * relative to c, rho and the energy of sound speed c, the particle's own or `sound`, whichever is
 * larger. To skip other updates would change sums by more than the tolerance. STATUS_*: as
 * run_execute. */
enum status bench_allowed(const struct run *run, const struct initial *initial, double tolerance,
                          double sound, double *share, struct error *error);
