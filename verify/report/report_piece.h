/* SPDX-License-Identifier: GPL-3.0-or-later
 * The pieces of a report that are not studies: runs with their profiles, groups of checks, kernel
 * certificates, the league of gradient operators, work-precision, savings by skips, autopsies; each
 * is one job of a pool. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "pool.h"
#include "run.h"

enum report_kind {
    REPORT_RUN,
    REPORT_CHECKS,
    REPORT_KERNEL,
    REPORT_LEAGUE,
    REPORT_BENCH,
    REPORT_SKIPS,
    REPORT_AUTOPSY
};

struct report_piece {
    enum report_kind kind;
    const char *where;            /* case, group, kernel */
    int dim;                      /* of a kernel */
    char keys[80];                /* of skips and autopsies, as words */
    const char *sizes;            /* of autopsies: 16^2,24^2,... */
    struct bench_rules rules;     /* of a bench and of skips */
    bool slow;                    /* includes slow checks */
    size_t case_number;           /* of a run */
    int scheme;                   /* of a run: index of its scheme */
    struct run_settings settings; /* of a run, a bench, skips, an autopsy */
    struct run run;               /* resolved by report_piece_add */
    size_t job;                   /* set by report_piece_add */
};

/* Adds the piece to a pool; it must outlive the pool. */
enum status report_piece_add(struct pool *pool, struct report_piece *piece, struct error *error);

/* Appends the checks of the verify document `part` to `verify`. */
void report_piece_join(json_t *verify, json_t *part);

/* Adds "bench" to the results: for each case of their "studies" the members "schemes" and "points"
 * of a document of `sphproof bench`, as far as the levels have the figures. */
void code_cost_add(json_t *results);
