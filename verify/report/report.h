/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a report computes: a list of independent tasks (runs with their profiles, convergence
 * studies, the checks, kernel certificates), each giving one piece of the results. */
#pragma once

#include <jansson.h>

#include "pool.h"
#include "run.h"
#include "status.h"

enum report_mode { REPORT_QUICK, REPORT_NIGHTLY };

/* Another code: what it is called, what has to stand on a command line for it to compute, and the
 * cases that it can run. Nothing is owned. */
struct report_code {
    const char *title, *option;
    size_t count;
    const struct run_settings *cases;
};
enum { REPORT_CODES_MAX = 5 };

struct report;

/* All that a report of this mode computes, in its pool; nothing has run. Owned by the caller. */
enum status report_create(enum report_mode mode, struct report **report, struct error *error);

/* The same of other codes, REPORT_CODES_MAX at most: all that they can run, beside our own default
 * scheme and SPH as textbooks have it. */
enum status report_create_codes(const struct report_code *codes, size_t count,
                                struct report **report, struct error *error);

/* To be run; the report's own. */
struct pool *report_pool(struct report *report);

/* After pool_run of all of it: judges it. *results is a document of command "report" as
 * reports/verdict.h describes it, owned by the caller; it has no history and no verdict yet. A gate
 * that fails, or a run that breaks down, is part of the results; anything else that goes wrong is
 * returned, and *results is then NULL. folder: faults.json and score.json, which
 * verify/test/faults.py and verify/mutants/score write, are shown if they are there; NULL: nowhere.
 */
enum status report_judge(struct report *report, const char *folder, json_t **results,
                         struct error *error);

void report_destroy(struct report *report);
