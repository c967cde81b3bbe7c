/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs foreign code in a process of its own. If the code crashes, does not return, exits, prints or
 * uses up its memory, the caller gets a message and nothing of the process remains. This is not a
 * sandbox: malicious code has all rights of the user who runs it. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "status.h"

/* Notes which foreign function is running, in memory that both processes share: guard_call before
 * the call, guard_back after it. Without a guarding process both do nothing. */
void guard_call(const char *function, double a, double b, int dim);
void guard_back(void);
/* From here on foreign code that fails is a kernel that fails; before, it is no kernel at all. */
void guard_begun(void);

/* The work; reply: what it has to say, a new reference. Runs in the other process. */
typedef enum status guard_work(const void *context, json_t **reply, struct error *error);

struct guard_verdict {
    bool ended;        /* the work came to its end; else see reason */
    json_t *reply;     /* of the work; NULL: none. Release with guard_free */
    bool begun;        /* guard_begun was called */
    char reason[400];  /* "crashes (Aborted) in sphproof_kernel_w(0.5, 1), call 7": no subject */
    char printed[200]; /* what was printed, its beginning, cleaned */
    size_t printed_bytes;
};

enum { GUARD_LIMIT = 300, GUARD_CALL_LIMIT = 1 }; /* seconds: in all; of the processor in a call */

/* Runs work, for at most limit seconds. Returns the status of the work if that came to its end,
 * with its message in error; STATUS_CHECK_FAILED or, if it had not begun, STATUS_BAD_INPUT if it
 * did not (verdict->reason, error not set); STATUS_ENVIRONMENT: no process, no memory. */
enum status guard_run(guard_work *work, const void *context, double limit,
                      struct guard_verdict *verdict, struct error *error);
void guard_free(struct guard_verdict *verdict);

/* From here on this process is the child of one that only waits for it: which ends as this one
 * does, but where foreign code has crashed, ended the process or does not come back from a call for
 * GUARD_WATCH_LIMIT seconds, says so of the subject ("kernel", "./mine.so") and ends with
 * STATUS_CHECK_FAILED. Before there are threads and open files; calls after the first one add their
 * subjects. STATUS_ENVIRONMENT: no process, no memory. */
enum { GUARD_WATCH_LIMIT = 5 };
enum status guard_watch(const char *what, const char *path, struct error *error);
