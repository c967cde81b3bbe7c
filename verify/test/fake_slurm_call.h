/* SPDX-License-Identifier: GPL-3.0-or-later
 * Calls the engine slurm for a study on the simulated cluster of fake_slurm.h. Include after
 * cmocka.h; needs _GNU_SOURCE. */
#pragma once

#include <fcntl.h>
#include <glob.h>

#include "fake_slurm.h"
#include "sample_jobs.h"
#include "sharing.h"

enum { N = 14, SHARES = 3 };

static const struct command_option list[] = {
    {"jobs", "J", ""},    {"n", "N", ""},         {"words", "WORDS", ""},  {"flag", NULL, ""},
    {"plot", "FILE", ""}, {"failures", NULL, ""}, {"history", "FILE", ""}, {"junit", "FILE", ""},
    {"resume", NULL, ""}, SHARING_OPTIONS,        {NULL, NULL, NULL},
};
static const struct command command = {.name = "converge", .options = list};

/* One call of the engine. */
static struct call {
    struct job_folder folder;
    struct pool pool;
    struct task tasks[N];
    struct options options;
    const char *values[sizeof list / sizeof *list];
    char *arguments[2];
    struct progress progress;
    struct slurm_work work;
    struct error error;
    bool reports;    /* its progress */
    char said[8000]; /* standard error */
} call;

static inline void set(const char *name, const char *value)
{
    for (size_t i = 0; list[i].name; i++)
        if (strcmp(list[i].name, name) == 0) call.values[i] = value;
}

/* A study of N computations in 3 shares, without results or tasks. */
static inline int begin(void **state)
{
    (void)state;
    call = (struct call){.options = {.command = &command, .threads = 1, .values = call.values}};
    job_folder_make(&call.folder);
    fill(&call.pool, call.tasks, &call.folder, N);
    slurm = (struct fake_slurm){.now = 100, .pool = &call.pool, .cache = &call.folder.cache};
    call.arguments[0] = (char *)"sod";
    call.options.arguments = call.arguments;
    call.options.count = 1;
    call.work = (struct slurm_work){.options = &call.options,
                                    .pool = &call.pool,
                                    .cache = &call.folder.cache,
                                    .jobs = 1,
                                    .tasks = SHARES,
                                    .progress = &call.progress};
    return 0;
}

static inline int end(void **state)
{
    (void)state;
    pool_free(&call.pool);
    job_folder_clear(&call.folder);
    return 0;
}

static inline void again(void)
{
    end(NULL);
    begin(NULL);
}

static inline enum status compute_all(void)
{
    char path[200];
    snprintf(path, sizeof path, "%s/said", call.folder.cache_folder);
    fflush(stderr);
    const int usual = dup(STDERR_FILENO), file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(usual >= 0 && file >= 0);
    dup2(file, STDERR_FILENO);
    progress_begin(&call.progress, "converge", !call.reports);
    call.error = (struct error){0};
    const enum status status = slurm_compute(&call.work, &call.error);
    fflush(stderr);
    dup2(usual, STDERR_FILENO);
    const ssize_t length = pread(file, call.said, sizeof call.said - 1, 0);
    call.said[length > 0 ? length : 0] = '\0';
    close(usual), close(file);
    assert_int_equal(status, call.error.status);
    return status;
}

static inline size_t lacking(void)
{
    size_t n = 0;
    for (size_t i = 0; i < call.pool.count; i++)
        n += !cache_has(&call.folder.cache, call.pool.jobs[i].key);
    return n;
}

/* Counts files in the engine's folder: its state, and logs. */
static inline size_t files(const char *pattern)
{
    char path[200];
    glob_t found;
    snprintf(path, sizeof path, "%s/slurm/%s", call.folder.cache_folder, pattern);
    const int none = glob(path, 0, NULL, &found);
    const size_t n = none ? 0 : found.gl_pathc;
    if (!none) globfree(&found);
    return n;
}

static inline void all_is_left_behind_in_order(void)
{
    assert_int_equal(lacking(), 0);
    assert_int_equal(files("*"), 0);
}

static inline void state_path(char path[300])
{
    glob_t found;
    snprintf(path, 300, "%s/slurm/*.json", call.folder.cache_folder);
    assert_int_equal(glob(path, 0, NULL, &found), 0);
    assert_int_equal(found.gl_pathc, 1);
    snprintf(path, 300, "%s", found.gl_pathv[0]);
    globfree(&found);
}

static inline void says(const char *what)
{
    if (strstr(call.said, what)) return;
    print_error("not said: %s\nsaid: %s", what, call.said);
    fail();
}

static inline void says_error(const char *what)
{
    if (strstr(call.error.message, what)) return;
    print_error("no such error: %s\nerror: %s\n", what, call.error.message);
    fail();
}

static inline size_t shares_computations(int share)
{
    int shares[N];
    size_t n = 0;
    struct error error = {0};
    assert_int_equal(pool_divide(&call.pool, SHARES, shares, &error), STATUS_OK);
    for (int i = 0; i < N; i++) n += shares[i] == share;
    return n;
}
