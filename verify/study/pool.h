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

/* Computes a document. STATUS_OK, STATUS_CHECK_FAILED and STATUS_BROKE_DOWN are results, which the
 * cache keeps with the error's message and the document, if there is one. */
typedef enum status pool_compute(const void *context, json_t **document, struct error *error);

struct pool_job {
    char *name;    /* for messages and progress */
    char *key;     /* in the cache */
    double weight; /* estimated time in any unit; heavy jobs start first */
    pool_compute *compute;
    const void *context; /* not owned */
    bool fickle;         /* a breakdown may not occur again */
    /* after pool_run: */
    bool done, cached;
    bool elsewhere;     /* in another share or in none: not computed */
    bool crashed;       /* its process crashed; nothing is cached */
    json_t *document;   /* NULL: none */
    struct error error; /* status of compute; STATUS_BROKE_DOWN if its process crashed */
};

struct pool {
    struct pool_job *jobs;
    size_t count;
    json_t *numbers; /* job index by key */
    size_t found;    /* in the cache, not computed */
    size_t damaged;  /* damaged cache entries, computed again */
    char note[512];  /* "", or why results could not be cached */
};

/* done of total jobs; share: completed fraction of the work, 0..1. Called several times a
 * second. */
typedef void pool_progress(void *context, const char *what, size_t done, size_t total,
                           double share);

/* One share of the jobs, for machines that compute side by side into one cache. A pure function of
 * the jobs' names, keys and weights. */
struct pool_share {
    int number, of; /* 1..of; of = 0: all jobs */
};

struct pool_settings {
    int jobs; /* simultaneous processes, >= 1 */
    struct pool_share share;
    const struct cache *cache; /* NULL: none */
    bool again;                /* repeat cached breakdowns of fickle jobs */
    pool_progress *progress;   /* may be NULL */
    void *progress_context;
};

/* Adds a job (name and key are copied) and returns its number; (size_t)-1: no memory. Jobs with
 * equal keys are one job; copy its document before changing it. */
size_t pool_add(struct pool *pool, const char *name, const char *key, double weight,
                pool_compute *compute, const void *context);

/* The number of the job with this key; (size_t)-1: there is none. */
size_t pool_find(const struct pool *pool, const char *key);

/* Writes the share of each job, 1..of, into shares (pool->count elements). Balanced by
 * weight: the heaviest job goes to the lightest share. STATUS_ENVIRONMENT: no memory. */
enum status pool_divide(const struct pool *pool, int of, int *shares, struct error *error);

/* Runs the jobs of the share. STATUS_ENVIRONMENT: no process or no memory; each job has its own
 * status. */
enum status pool_run(struct pool *pool, const struct pool_settings *settings, struct error *error);

/* For a job that starts processes of its own: the job and they end when the pool's process ends. */
void pool_end_with_parent(void);

void pool_free(struct pool *pool);
