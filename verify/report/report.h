/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a report computes: a list of independent tasks (runs with their profiles, convergence
 * studies, the checks, kernel certificates), each giving one piece of the results. */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "pool.h"
#include "run.h"
#include "status.h"

/* Another code: its name, the command-line option that selects it, and the cases that it can run.
 * Nothing is owned. */
struct report_code {
    const char *title, *option;
    size_t count;
    const struct run_settings *cases;
};
enum { REPORT_CODES_MAX = 5 };

struct report;

/* Creates a report with all its jobs in a pool; nothing has run. codes: NULL for our own program,
 * or REPORT_CODES_MAX other codes at most: all cases that they can run, beside our default scheme
 * and textbook SPH. Owned by the caller. */
enum status report_create(bool nightly, const struct report_code *codes, size_t count,
                          struct report **report, struct error *error);

/* The pool to run; owned by the report. */
struct pool *report_pool(struct report *report);

/* Call after pool_run. Judges the report; *results is a document of command "report" as in
 * reports/verdict.h, owned by the caller, without history and verdict. A failed gate or a run that
 * broke down is part of the results; any other failure is returned, with *results NULL. folder:
 * shows faults.json and score.json, which verify/test/faults.py and verify/mutants/score write, if
 * they are there; NULL: does not. */
enum status report_judge(struct report *report, const char *folder, json_t **results,
                         struct error *error);

void report_destroy(struct report *report);
