/* SPDX-License-Identifier: GPL-3.0-or-later
 * The snapshot that a run of a code leaves: which file it is, and whether it can be a result of the
 * initial state that the code was given. */
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

/* Files whose names fit a pattern; of those that are there before a run, how they were. */
struct code_matches {
    size_t n;
    char **path; /* short names first, else in the order of their bytes */
    struct stat *was;
};

/* False: no memory. */
bool code_match(const char *pattern, struct code_matches *matches);
void code_matches_free(struct code_matches *matches);

/* The last of those that a run has written which began at that time; NULL and a reason:
 * there are none, or old ones. */
const char *code_last(const struct code_matches *now, const struct code_matches *before,
                      time_t began, enum code_reason *reason);

/* Has the run written the i-th of them? */
bool code_is_new(const struct code_matches *now, size_t i, const struct code_matches *before,
                 time_t began);

/* The first of those that a run has written, which may be of its start; NULL: there is none but
 * `last`. */
const char *code_first(const struct code_matches *now, const struct code_matches *before,
                       time_t began, const char *last);

/* What a snapshot is compared with. */
struct code_origin {
    const struct snapshot_file *ic; /* the initial state; NULL: it cannot be read */
    const struct prepared *problem;
    double t_end;
    bool cells; /* the code has cells, not particles of the initial state */
};

/* Is it a result at t_end? The message says what is wrong. t_end is met to a thousandth. */
enum code_reason code_compare(const struct snapshot_file *file, const struct code_origin *origin,
                              char *message, size_t size);

/* Is a snapshot of the time 0 that initial state? True also of another time, and where one of the
 * two does not have what could be compared. */
bool code_is_start(const struct snapshot_file *file, const struct code_origin *origin,
                   char *message, size_t size);
