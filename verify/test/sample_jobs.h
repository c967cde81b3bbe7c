/* SPDX-License-Identifier: GPL-3.0-or-later
 * Jobs for tests of the pool and of the cache: each counts its computations and leaves a known
 * document; some crash or take long. Include after test.h. */
#pragma once

#include <ftw.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include "pool.h"
#include "result.h"

enum { JOBS = 7 };

/* The folder of one test: the cache, and a file that grows by a byte with each computation. */
struct job_folder {
    char path[64], count[80], cache_folder[80];
    struct cache cache;
};

struct task {
    const struct job_folder *folder;
    int number;
    enum { SOUND, BROKEN, CRASHES, SLOW } kind;
};

static inline enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct task *task = context;
    FILE *count = fopen(task->folder->count, "a");
    fputc('.', count);
    fclose(count);
    if (task->kind == CRASHES) raise(SIGKILL);
    if (task->kind == SLOW) sleep(60);
    *document = json_pack("{s:i, s:o, s:o}", "number", task->number, "third",
                          result_number(task->number / 3.), "nan", result_number(0 / 0.));
    if (task->number == 1) { /* larger than any pipe's capacity */
        char *long_text = malloc(300001);
        memset(long_text, 'a', 300000);
        long_text[300000] = '\0';
        json_object_set_new(*document, "long", json_string(long_text));
        free(long_text);
    }
    return task->kind == BROKEN ? error_set(error, STATUS_BROKE_DOWN, "particle 3") : STATUS_OK;
}

static inline void job_folder_make(struct job_folder *folder)
{
    struct error error = {0};
    strcpy(folder->path, "pool.XXXXXX");
    assert_non_null(mkdtemp(folder->path));
    snprintf(folder->count, sizeof folder->count, "%s/count", folder->path);
    snprintf(folder->cache_folder, sizeof folder->cache_folder, "%s/cache", folder->path);
    assert_int_equal(cache_open(&folder->cache, folder->cache_folder, false, &error), STATUS_OK);
}

static inline int remove_one(const char *path, const struct stat *is, int type, struct FTW *depth)
{
    (void)is, (void)type, (void)depth;
    return remove(path);
}

static inline void job_folder_clear(const struct job_folder *folder)
{
    nftw(folder->cache_folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
    unlink(folder->count);
    rmdir(folder->path);
}

static inline long computed(const struct job_folder *folder)
{
    struct stat is;
    return stat(folder->count, &is) ? 0 : (long)is.st_size;
}

static inline void fill(struct pool *pool, struct task *tasks, const struct job_folder *folder,
                        size_t n)
{
    *pool = (struct pool){0};
    for (size_t i = 0; i < n; i++) {
        char name[32];
        tasks[i].folder = folder;
        tasks[i].number = (int)i;
        snprintf(name, sizeof name, "task %zu", i);
        assert_int_equal(pool_add(pool, name, name, (double)(i % 3), compute, &tasks[i]), i);
    }
}

static inline enum status run(struct pool *pool, const struct cache *cache, int jobs)
{
    struct error error = {0};
    const struct pool_settings settings = {.jobs = jobs, .cache = cache};
    return pool_run(pool, &settings, &error);
}

static inline void same_results(const struct pool *a, const struct pool *b)
{
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        assert_true(a->jobs[i].done && b->jobs[i].done);
        assert_true(json_equal(a->jobs[i].document, b->jobs[i].document));
        assert_int_equal(a->jobs[i].error.status, b->jobs[i].error.status);
        assert_string_equal(a->jobs[i].error.message, b->jobs[i].error.message);
    }
}
