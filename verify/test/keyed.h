/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes settings, schemes and runs from a line of keys, such as "n=100 t_end=0.1 left=1,0,1". A
 * test fails if they are refused. Include after test.h. */
#pragma once

#include "run.h"

enum { KEYED_MOST = 16 };

struct keyed_words {
    char text[256], *word[KEYED_MOST];
    int n;
};

/* The words of a line, separated by any of these characters. */
static inline void keyed_words(struct keyed_words *words, const char *line, const char *between)
{
    char *rest = words->text;
    assert_true(strlen(line) < sizeof words->text);
    strcpy(words->text, line);
    words->n = 0;
    for (char *word; (word = strtok_r(rest, between, &rest));) {
        assert_true(words->n < KEYED_MOST);
        words->word[words->n++] = word;
    }
}

static inline struct settings keyed_settings(const char *line)
{
    struct keyed_words words;
    struct settings settings;
    struct error error;
    keyed_words(&words, line, " ");
    settings_init(&settings);
    if (settings_apply(&settings, words.n, words.word, &error))
        fail_msg("%s: %s", line, error.message);
    return settings;
}

static inline struct scheme keyed_scheme(int dim, const char *line)
{
    struct settings settings = keyed_settings(line);
    struct scheme scheme;
    struct error error;
    if (settings_scheme(&settings, dim, &scheme, &error)) fail_msg("%s: %s", line, error.message);
    return scheme;
}

/* The settings of a case with these keys. */
static inline struct run_settings keyed_case(const char *name, const char *line)
{
    struct keyed_words words;
    struct run_settings settings;
    struct error error;
    keyed_words(&words, line, " ");
    if (run_prepare(&settings, name, words.n, words.word, &error))
        fail_msg("%s %s: %s", name, line, error.message);
    return settings;
}

static inline struct run keyed_run(const char *name, const char *line)
{
    const struct run_settings settings = keyed_case(name, line);
    struct run run = {0};
    struct error error;
    if (run_resolve(&run, &settings, &error)) fail_msg("%s %s: %s", name, line, error.message);
    return run;
}

/* The caller frees it with run_free. */
static inline struct run_result keyed_result(const struct run *run)
{
    struct run_result result = {0};
    struct error error;
    if (run_execute(run, &result, &error)) fail_msg("%s", error.message);
    return result;
}
