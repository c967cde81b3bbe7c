/* SPDX-License-Identifier: GPL-3.0-or-later
 * Records of running foreign functions in memory shared by the process that runs them and the
 * process that watches it. Internal to guard.c and guard_watch.c. */
#pragma once

#include <stdatomic.h>
#include <stddef.h>

#include "status.h"

/* The current call of one thread. Function names are literals, which have the same address in both
 * processes. */
struct trace {
    _Alignas(64) const char *volatile function;
    volatile double a, b;
    volatile int dim;
    volatile long calls;
    volatile int inside;
};

/* Each thread, also of a child process, takes the next trace at its first call. Traces are reused
 * in turn, so that any number of short-lived threads may follow each other. */
enum { GUARD_TRACES = 256 };
struct watch {
    volatile int begun, stuck, complete;
    char subject[300]; /* named by guard_watch */
    atomic_uint taken;
    struct trace traces[GUARD_TRACES];
};

/* Where this process records calls; NULL: no process watches it. */
extern struct watch *guard_watched;

/* Creates the shared memory; unmap it after use. NULL: no memory. */
struct watch *guard_watch_make(struct error *error);

/* Makes this process end when its parent ends. */
void guard_end_with_parent(void);

/* " in FUNCTION(a, b, dim), call 7", " after ..." or "". */
void guard_place(const struct trace *seen, char *text, size_t size);
