/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes problems from a line of keys, and finds parts of their descriptors by name. Include after
 * test.h. */
#pragma once

#include "initial.h"
#include "keyed.h"
#include "problem_list.h"
#include "problem_prepare.h"

/* So that malloc returns NULL with sanitizers, too, if there is not enough memory. */
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "allocator_may_return_null=1";
}
const char *__tsan_default_options(void);
const char *__tsan_default_options(void)
{
    return "allocator_may_return_null=1";
}

/* keys: up to 16, separated by |. */
static inline enum status prepared_try(struct prepared *p, struct settings *settings, int dim,
                                       const char *keys, struct error *error)
{
    struct keyed_words words;
    *error = (struct error){0};
    keyed_words(&words, keys, "|");
    settings_init(settings);
    if (settings_apply(settings, words.n, words.word, error)) fail_msg("%s", error->message);
    return problem_prepare(p, settings, dim, error);
}

static inline struct prepared prepared_of(struct settings *settings, int dim, const char *keys)
{
    struct prepared p;
    struct error error;
    if (prepared_try(&p, settings, dim, keys, &error)) fail_msg("%s: %s", keys, error.message);
    return p;
}

/* The problem must refuse these keys with these words. */
static inline void prepared_refused(int dim, const char *keys, const char *words)
{
    struct prepared p;
    struct settings settings;
    struct error error;
    const enum status status = prepared_try(&p, &settings, dim, keys, &error);
    if (status != STATUS_BAD_INPUT || !strstr(error.message, words))
        fail_msg("%s: '%s' expected, said: %s", keys, words, error.message);
}

/* The initial particles of a prepared problem. */
static inline struct initial prepared_filled(const struct prepared *p,
                                             const struct settings *settings)
{
    struct initial initial = {0};
    struct error error = {0};
    if (p->problem->fill(p, settings, &initial, &error)) fail_msg("%s", error.message);
    return initial;
}

static inline const struct functional *prepared_functional(const struct prepared *p,
                                                           const char *name)
{
    for (const struct functional *const *f = p->problem->functionals; *f; f++)
        if (strcmp((*f)->name, name) == 0) return *f;
    fail_msg("no functional %s", name);
    return NULL;
}
