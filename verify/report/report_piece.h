/* SPDX-License-Identifier: GPL-3.0-or-later
 * The pieces of a report that are no studies: runs with their profiles, groups of checks, kernel
 * certificates, the league of gradient operators, what an error costs, what skips save, what an
 * order is lost to; each one job of a pool. */
#pragma once

#include <jansson.h>

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
    char keys[80];                /* of skips and autopsies, as words; */
    const char *sizes;            /* of autopsies: 16^2,24^2,... */
    bool slow;                    /* the slow checks too */
    size_t case_number;           /* of a run, */
    int scheme;                   /* and what it is compared as */
    struct run_settings settings; /* of a run, a bench, skips, an autopsy */
    struct run run;               /* the same, from report_piece_add */
    size_t job;                   /* its number, from report_piece_add */
};

/* Adds the piece to a pool; it must outlive the pool. */
enum status report_piece_add(struct pool *pool, struct report_piece *piece, struct error *error);

/* Adds the checks of a verify document to another one. */
void report_piece_join(json_t *verify, json_t *part);

/* Adds to results "bench": a document for each case of results' "studies", "schemes" and "points"
 * as those of `sphproof bench` have them, as far as levels say it. */
void code_cost_add(json_t *results);
