/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "guard_trace.h"

#include <errno.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "guard.h"

struct watch *guard_watched;

static _Thread_local struct trace nowhere, *trace;

static struct trace *own_trace(void)
{
    if (!trace)
        trace =
            guard_watched
                ? &guard_watched->traces[atomic_fetch_add(&guard_watched->taken, 1) % GUARD_TRACES]
                : &nowhere;
    return trace;
}

void guard_call(const char *function, double a, double b, int dim)
{
    struct trace *now = own_trace();
    now->function = function;
    now->a = a;
    now->b = b;
    now->dim = dim;
    now->calls++;
    now->inside = 1;
}

void guard_back(void)
{
    own_trace()->inside = 0;
}

void guard_begun(void)
{
    if (guard_watched) guard_watched->begun = 1;
}

void guard_end_with_parent(void)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
}

/* Called in a new process, which has one thread. */
static void forget_trace(void)
{
    trace = NULL;
}

struct watch *guard_watch_make(struct error *error)
{
    static bool prepared;
    void *shared =
        mmap(NULL, sizeof(struct watch), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) {
        error_set(error, STATUS_ENVIRONMENT, "no memory: %s", strerror(errno));
        return NULL;
    }
    if (!prepared) pthread_atfork(NULL, NULL, forget_trace);
    prepared = true;
    struct watch *watch = shared; /* zeros */
    for (int t = 0; t < GUARD_TRACES; t++) watch->traces[t].a = watch->traces[t].b = (double)NAN;
    return watch;
}

void guard_place(const struct trace *seen, char *text, size_t size)
{
    char arguments[80] = "";
    if (!seen->function) {
        snprintf(text, size, "%s", "");
        return;
    }
    if (isfinite(seen->b))
        snprintf(arguments, sizeof arguments, "(%.9g, %.9g, %d)", seen->a, seen->b, seen->dim);
    else if (isfinite(seen->a))
        snprintf(arguments, sizeof arguments, "(%.9g, %d)", seen->a, seen->dim);
    else if (seen->dim)
        snprintf(arguments, sizeof arguments, "(%d)", seen->dim);
    snprintf(text, size, " %s %s%s, call %ld", seen->inside ? "in" : "after", seen->function,
             arguments, seen->calls);
}
