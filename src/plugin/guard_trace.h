/* SPDX-License-Identifier: GPL-3.0-or-later
 * What foreign code is at, in memory that the process it runs in shares with the one that watches:
 * for guard.c and guard_watch.c. */
#pragma once

#include <stdatomic.h>
#include <stddef.h>

#include "status.h"

/* What one thread is at. Names of functions are literals, at the same address in both processes. */
struct trace {
    _Alignas(64) const char *volatile function;
    volatile double a, b;
    volatile int dim;
    volatile long calls;
    volatile int inside;
};

/* Threads, and processes that the watched one starts itself, take the next trace at their first
 * call; in a ring, so that many short-lived ones may follow each other. */
enum { GUARD_TRACES = 256 };
struct watch {
    volatile int begun, stuck, complete;
    char subject[300]; /* of guard_watch */
    atomic_uint taken;
    struct trace traces[GUARD_TRACES];
};

/* Where this process writes its traces; NULL: no other process reads them. */
extern struct watch *guard_watched;

/* NULL: no memory. Unmap it. */
struct watch *guard_watch_make(struct error *error);

/* " in FUNCTION(a, b, dim), call 7", " after ..." or "". */
void guard_place(const struct trace *seen, char *text, size_t size);
