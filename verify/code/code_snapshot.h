/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the snapshot of another code's run and tests whether it can result from the code's initial
 * state. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>

#include "problem.h"
#include "snapshot_file.h"

/* Why a run has no result; REASON_NONE: it has one. */
#define CODE_REASON_LIST(REASON)                                                                   \
    REASON(no_program)                                                                             \
    REASON(exit_status)                                                                            \
    REASON(timeout)                                                                                \
    REASON(memory)                                                                                 \
    REASON(no_snapshot)                                                                            \
    REASON(old_snapshot)                                                                           \
    REASON(truncated)                                                                              \
    REASON(not_a_number)                                                                           \
    REASON(wrong_time)                                                                             \
    REASON(wrong_gamma)                                                                            \
    REASON(wrong_particles)                                                                        \
    REASON(ignored_ic)
enum code_reason {
    REASON_NONE,
#define REASON(name) REASON_##name,
    CODE_REASON_LIST(REASON)
#undef REASON
        REASONS
};
extern const char *const code_reason_names[REASONS]; /* as results write them; "" of none */

/* Files whose names match a pattern, with their state before the run. */
struct code_matches {
    size_t n;
    char **path; /* short names first, else in the order of their bytes */
    struct stat *was;
};

/* False: no memory. */
bool code_match(const char *pattern, struct code_matches *matches);
void code_matches_free(struct code_matches *matches);

/* The last file written by a run that began at that time; NULL and a reason if there is none, or
 * only old ones. */
const char *code_last(const struct code_matches *now, const struct code_matches *before,
                      time_t began, enum code_reason *reason);

/* True if the run has written the i-th file. */
bool code_is_new(const struct code_matches *now, size_t i, const struct code_matches *before,
                 time_t began);

/* The first file written by the run, possibly of its start; NULL: none but `last`. */
const char *code_first(const struct code_matches *now, const struct code_matches *before,
                       time_t began, const char *last);

/* What a snapshot is compared with. */
struct code_origin {
    const struct snapshot_file *ic; /* the initial state; NULL: it cannot be read */
    const struct prepared *problem;
    double t_end;
    bool cells; /* the code has cells instead of the initial particles */
};

/* REASON_NONE if the file is a result at t_end, to a thousandth; else the reason, and a message. */
enum code_reason code_compare(const struct snapshot_file *file, const struct code_origin *origin,
                              char *message, size_t size);

/* False if a snapshot of the time 0 differs from the initial state. True for another time, or if
 * one of the two lacks comparable fields. */
bool code_is_start(const struct snapshot_file *file, const struct code_origin *origin,
                   char *message, size_t size);
