/* SPDX-License-Identifier: GPL-3.0-or-later
 * Passes: the same work on every range, shared among threads. Ranges are independent, and one
 * thread handles each of them, so results do not depend on the number of threads. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct range;
struct simulation;

/* Results of one thread in a pass: sums, minima and maxima that do not depend on the order. Ranges
 * stay with their threads, because inspecting them after a pass would cost more than the pass. */
struct tally {
    int thread;
    ptrdiff_t without_root; /* first particle without a root; PTRDIFF_MAX: none */
    bool short_of_ghosts;
    ptrdiff_t reach; /* largest */
    double crossings, rate;
    uint64_t pairs, without_viscosity, without_slope;
};

/* The work on one range; adds its results to tally, which belongs to the calling thread. */
typedef void range_pass(struct simulation *simulation, struct range *range, struct tally *tally);

/* Applies a pass to all ranges of a simulation. Returns the combined results of all threads. */
struct tally pass_all(struct simulation *simulation, range_pass *pass);
