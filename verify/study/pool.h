/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs independent computations side by side, each in a process of its own: they share no memory, a
 * crash ends only its own computation, and results do not depend on how many run at once. Results
 * that the cache already holds are not computed again, and each new result is cached at once, so
 * that an interruption loses only unfinished ones. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "cache.h"
#include "status.h"

/* Computes a document. STATUS_OK, STATUS_CHECK_FAILED and STATUS_BROKE_DOWN are results: they are
 * kept, with error's message and the document, if there is one. */
typedef enum status pool_compute(const void *context, json_t **document, struct error *error);

struct pool_job {
    char *name;    /* for messages and progress */
    char *key;     /* of the cache; NULL: never kept */
    double weight; /* about how long it takes, in any unit; heavy ones start first */
    pool_compute *compute;
    const void *context; /* not owned */
    bool fickle;         /* what breaks down may not do so the next time */
    /* after pool_run: */
    bool done, cached;
    bool elsewhere;     /* it is in another share, or in none: nothing was done about it */
    bool crashed;       /* its process did: nothing of it is kept */
    json_t *document;   /* NULL where there is none */
    struct error error; /* status of compute; STATUS_BROKE_DOWN also where its process crashed */
};

struct pool {
    struct pool_job *jobs;
    size_t count;
    json_t *numbers; /* of jobs, by their keys */
    size_t found;    /* in the cache */
    size_t damaged;  /* were in the cache, but not whole: computed again */
    char note[512];  /* "", or why entries could not be kept */
};

/* done of total jobs; share: of the work that was to be done, 0..1. Called several times a second.
 */
typedef void pool_progress(void *context, const char *what, size_t done, size_t total,
                           double share);

/* One of so many shares of the jobs, which machines compute side by side into one cache: a pure
 * function of the jobs' names, keys and weights. What no cache keeps is in no share. */
struct pool_share {
    int number, of; /* 1..of; of = 0: all jobs */
};

struct pool_settings {
    int jobs; /* processes at once, >= 1 */
    struct pool_share share;
    const struct cache *cache; /* NULL: none */
    bool again;              /* what is kept and broke down is computed once more if it is fickle */
    pool_progress *progress; /* may be NULL */
    void *progress_context;
};

/* Adds a job (name and key are copied) and returns its number, (size_t)-1 without memory. One whose
 * key is there already is that job: nothing is computed twice, and who changes its document copies
 * it first. */
size_t pool_add(struct pool *pool, const char *name, const char *key, double weight,
                pool_compute *compute, const void *context);

/* The number of the job with this key, (size_t)-1: there is none. */
size_t pool_find(const struct pool *pool, const char *key);

/* The share of each job, 1..of, into shares (of pool->count); 0: none. Even by weight: the heaviest
 * job goes where least is. STATUS_ENVIRONMENT: no memory. */
enum status pool_divide(const struct pool *pool, int of, int *shares, struct error *error);

/* Runs the jobs of the share. STATUS_ENVIRONMENT: no process or no memory; what single jobs say is
 * in them. */
enum status pool_run(struct pool *pool, const struct pool_settings *settings, struct error *error);

/* For a job whose work goes on in processes of its own: it, and with it they, end when the process
 * of the pool does. */
void pool_end_with_parent(void);

void pool_free(struct pool *pool);
