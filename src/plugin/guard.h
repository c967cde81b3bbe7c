/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs foreign code in a child process. If the code crashes, hangs, exits, prints or exhausts its
 * memory, the caller gets a message, and nothing of the process remains. This is not a sandbox:
 * malicious code has all rights of the user. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "status.h"

/* Records the running foreign function in shared memory: guard_call before the call, guard_back
 * after it. In a process that is not guarded both do nothing. */
void guard_call(const char *function, double a, double b, int dim);
void guard_back(void);
/* After this call a failure of foreign code is a failed check (STATUS_CHECK_FAILED), before it an
 * unusable file (STATUS_BAD_INPUT). */
void guard_begun(void);

/* Work in the child process; reply: result, a new reference. */
typedef enum status guard_work(const void *context, json_t **reply, struct error *error);

struct guard_verdict {
    bool ended;       /* the work completed; else see reason */
    json_t *reply;    /* of the work; NULL: none. Free with guard_free */
    bool begun;       /* guard_begun was called */
    char reason[400]; /* "crashes (Aborted) in sphproof_kernel_w(0.5, 1), call 7", without a subject
                       */
    char printed[200]; /* beginning of the printed output, sanitised */
    size_t printed_bytes;
};

enum { GUARD_LIMIT = 300, GUARD_CALL_LIMIT = 1 }; /* seconds: total; CPU time per call */

/* Runs work for at most limit seconds. If the work completed, returns its status, with its message
 * in error. Else returns STATUS_CHECK_FAILED or, if guard_begun was not called, STATUS_BAD_INPUT;
 * verdict->reason is set, error is not. STATUS_ENVIRONMENT: no process, no memory. */
enum status guard_run(guard_work *work, const void *context, double limit,
                      struct guard_verdict *verdict, struct error *error);
void guard_free(struct guard_verdict *verdict);

/* Forks. The parent only waits for the child, which returns from this call, and ends as the child
 * does. If foreign code crashes, ends the process or does not return from a call within
 * GUARD_WATCH_LIMIT seconds, the parent reports the subject ("kernel", "./mine.so") and ends with
 * STATUS_CHECK_FAILED. Call it before starting threads and opening files; further calls only add
 * their subjects. STATUS_ENVIRONMENT: no process, no memory. */
enum { GUARD_WATCH_LIMIT = 5 };
enum status guard_watch(const char *what, const char *path, struct error *error);
