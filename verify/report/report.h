/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a report computes: a list of independent tasks (runs with their profiles, convergence
 * studies, the checks, kernel certificates), each giving one piece of the results. */
#ifndef SPHPROOF_REPORT_H
#define SPHPROOF_REPORT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "pool.h"
#include "status.h"

enum report_mode { REPORT_QUICK, REPORT_NIGHTLY };

struct report_settings {
    enum report_mode mode;
    int jobs;                  /* >= 1: tasks side by side */
    const struct cache *cache; /* what is computed is kept there and not repeated; NULL: none */
    pool_progress *progress;   /* may be NULL */
    void *context;
    const char *faults; /* what verify/test/faults.py wrote, shown if it is there; NULL: nowhere */
};

/* Computes all and judges it: *results is a document of command "report" with its verdict (see
 * reports/verdict.h), owned by the caller. A gate that fails, or a run that breaks down, is part of
 * the results; anything else that goes wrong is returned, and *results is then NULL. */
enum status report_compute(const struct report_settings *settings, json_t **results,
                           struct error *error);

/* Computes nothing: the names of what a report of this mode computes, one a line. */
enum status report_list(enum report_mode mode, FILE *stream, struct error *error);

#endif
