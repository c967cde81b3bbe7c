/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes allocations fail: the linker's --wrap redirects allocations of parts of the project to this
 * file. The first one fails, then the second one, and so on until none fails. Include after
 * cmocka.h, in tests of meson.build's list `wraps`. */
#pragma once

#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "status.h"

static atomic_int left = -1; /* calls until one fails; < 0: none fails */
static atomic_long held;     /* blocks that are not freed */

static int spared; /* number of calls that may fail without an error */

static void (*at_each_call)(void); /* NULL: nothing */

static bool fails(void)
{
    if (at_each_call) at_each_call();
    const bool now = left >= 0 && left-- == 0;
    if (now) errno = ENOMEM;
    return now;
}

/* WRAP(name, parameters, arguments, new) defines the function that the linker calls in place of
 * name; new: does a call add a block? */
#define WRAP(name, parameters, arguments, new)                                                     \
    void *__real_##name parameters;                                                                \
    void *__wrap_##name parameters;                                                                \
    void *__wrap_##name parameters                                                                 \
    {                                                                                              \
        const bool more = new;                                                                     \
        void *given = fails() ? NULL : __real_##name arguments;                                    \
        if (given && more) held++;                                                                 \
        return given;                                                                              \
    }
WRAP(malloc, (size_t size), (size), true)
WRAP(calloc, (size_t n, size_t size), (n, size), true)
WRAP(realloc, (void *memory, size_t size), (memory, size), !memory)
WRAP(aligned_alloc, (size_t alignment, size_t size), (alignment, size), true)
WRAP(strdup, (const char *text), (text), true)

void __real_free(void *memory);
void __wrap_free(void *memory);
void __wrap_free(void *memory)
{
    if (memory) held--;
    __real_free(memory);
}

/* Lets each call for memory of `work` fail once: `work` must return the error, and free all blocks.
 * There must be at least `least` calls; if not `all`, later calls need not be errors. */
static inline void without_memory(enum status work(struct error *error), int least, bool all)
{
    for (int k = 0;; k++) {
        struct error error = {0};
        const long before = held;
        left = k;
        const enum status status = work(&error);
        const bool done = left >= 0 || (!all && k >= least);
        left = -1;
        if (held != before) fail_msg("call %d: %ld pieces are left", k, held - before);
        if (done) {
            if (all && status) fail_msg("with memory: status %d: %s", status, error.message);
            assert_true(k >= least);
            return;
        }
        if (!status && spared-- > 0) continue;
        if (status != STATUS_ENVIRONMENT || !strstr(error.message, "no memory"))
            fail_msg("call %d: status %d: %s", k, status, error.message);
    }
}
