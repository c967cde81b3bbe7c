/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the solver's loops in 1D without a simulation: particles at rest, known neighbour offsets,
 * contiguous arrays. A whole step costs in addition search, bookkeeping and memory. */
#pragma once

#include <stdbool.h>

#include "bench.h"
#include "line/line.h"
#include "plan.h"

enum { BENCH_LOOPS_PARTICLES = 1600 }; /* particles used for tables */

struct bench_loops {
    struct scheme scheme;
    struct loops loops; /* points into scheme: do not move the struct */
    struct plan plan;
    struct particles particles;
    ptrdiff_t reach; /* offsets within the smoothing lengths */
    double *scratch;
    double dt;       /* 0, which the compiler cannot know */
    double rate;     /* a result, so that no pass is optimised away */
    unsigned passes; /* passes of bench_loops_work: 1 << enum bench_pass */
    uint64_t pairs;  /* of one run of these passes, counted as by the solver */
};

/* PASS_STATE: the arithmetic of a step without pairs, as in predicted_midpoint with predicted h:
 * motion, smoothing lengths, equation of state. PASS_ORDER, PASS_REACH: the tests that order and
 * neighbour ranges are still valid; PASS_SORT, PASS_SEARCH: rebuilding them. */
enum bench_pass {
    PASS_STATE,
    PASS_DENSITY,
    PASS_MATRIX,
    PASS_FORCE,
    PASS_SIGNAL,
    PASS_ORDER,
    PASS_REACH,
    PASS_SORT,
    PASS_SEARCH,
    PASS_NONE
};

/* A slightly disordered lattice of n particles, with every array that the scheme's loops read;
 * passes that the scheme does not have are left out. specialised: as in loops_choose.
 * STATUS_ENVIRONMENT: no memory. Free with bench_loops_free, also after a failure. */
enum status bench_loops_create(struct bench_loops *loops, const struct scheme *scheme, size_t n,
                               bool specialised, unsigned passes, struct error *error);
void bench_loops_free(struct bench_loops *loops);

/* A bench_work; context: struct bench_loops. */
enum status bench_loops_work(void *context, uint64_t times, struct clock_taken *taken,
                             struct error *error);
