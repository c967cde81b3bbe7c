/* SPDX-License-Identifier: GPL-3.0-or-later
 * Passes: the same work on every range, shared out among threads. Ranges are independent of each
 * other and each is worked on by one thread, so results do not depend on the number of threads. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct range;
struct simulation;

/* What one thread finds in a pass: sums, minima and maxima that do not depend on any order. Ranges
 * stay with their threads; to look through them after a pass would cost more than a pass. */
struct tally {
    int thread;
    ptrdiff_t without_root; /* first particle, PTRDIFF_MAX: none */
    bool short_of_ghosts;
    ptrdiff_t reach; /* largest */
    double crossings, rate;
    uint64_t pairs, without_viscosity, without_slope;
};

/* The work on one range. It adds its counts to tally, which belongs to the calling thread. */
typedef void range_pass(struct simulation *simulation, struct range *range, struct tally *tally);

/* A pass over all ranges of a simulation. Returns what all threads have found together. */
struct tally pass_all(struct simulation *simulation, range_pass *pass);
