/* SPDX-License-Identifier: GPL-3.0-or-later
 * One run of another code in place of our solver: writes the initial state, fills in the templates,
 * runs the command in a folder of its own, judges the last snapshot, and makes the document of
 * `sphproof run` with "code" and "judged" in addition. Ladders, orders, gates, pages and history
 * read only such documents, whichever code has run. */
#pragma once

#include <stdint.h>

#include "code_file.h"
#include "judge.h"
#include "run.h"

/* Options of commands that run codes. */
#define CODE_OPTION_HELP                                                                           \
    "another program computes, which this file describes (`sphproof list code_keys`)"
#define CODE_WORK_HELP                                                                             \
    "with --code: keep the folder of each run there (initial state, templates, logs, snapshots)"

/* The object of run_settings.external; must not move while runs use it. */
struct code_external {
    struct run_external base;
    const struct code *code;
    const struct code_case *of;
    const char *work;   /* folder that keeps the runs' folders; NULL: they are removed */
    uint64_t variation; /* seed of a variation of the start by 2 units in the last place; 0: none */
};

/* The settings of a case of the code with KEY=VALUE arguments; settings->external becomes external.
 * STATUS_BAD_INPUT: the code has no such case, or keys are wrong. */
enum status code_plan(const struct code *code, const char *case_name, const char *work, int n,
                      char *const *arguments, struct code_external *external,
                      struct run_settings *settings, struct error *error);
/* Like code_plan, but also fails if the program is missing. */
enum status code_prepare(const struct code *code, const char *case_name, const char *work, int n,
                         char *const *arguments, struct code_external *external,
                         struct run_settings *settings, struct error *error);

/* Runs the code. STATUS_OK: *judged is filled (call judge_free); STATUS_BROKE_DOWN: the document
 * has "failed" and "reason", and error the last lines of the log. Any other status leaves nothing
 * to free. */
enum status code_run(const struct run *run, struct judged *judged, json_t **document,
                     struct error *error);
