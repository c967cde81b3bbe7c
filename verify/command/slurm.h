/* SPDX-License-Identifier: GPL-3.0-or-later
 * --engine slurm: computes the shares of a study as an array of tasks on a cluster; and the calls
 * of sbatch, squeue and scancel, for arrays of tasks under one name. Slurm's manuals: sbatch(1),
 * squeue(1), scancel(1). */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "cache.h"
#include "command.h"
#include "pool.h"
#include "progress.h"

enum { SLURM_WORDS_MAX = 64, SLURM_TASKS_MAX = 1000 }; /* tasks: Slurm's usual MaxArraySize - 1 */

/* The work of a cluster. Nothing is owned. */
struct slurm_work {
    const struct options *options; /* of the command line; a share's command line is made from it */
    const struct pool *pool;
    const struct cache *cache;
    int jobs;  /* processes of a share */
    int tasks; /* shares; 0: about ten minutes of work each */
    struct progress *progress;
};

/* Computes all jobs with a key, in shares, into the cache; the pool runs afterwards, takes the
 * results from there and computes the rest. STATUS_ENVIRONMENT: some results are missing; the
 * others are kept. */
enum status slurm_compute(const struct slurm_work *work, struct error *error);

/* A task of an array, as the controller reports it, until some minutes after its end. */
struct slurm_task {
    long job;        /* of the array */
    int index;       /* in the array; 0: all tasks that waited when the array was cancelled */
    bool live;       /* waiting, running or to be requeued */
    char state[24];  /* RUNNING, TIMEOUT ... */
    char reason[64]; /* why it waits */
};

/* Runs sbatch with words (ends with NULL); *job: the array's number. */
enum status slurm_submit(const char *const *words, long *job, struct error *error);

/* All tasks of the arrays of this name; malloced, the caller frees. */
enum status slurm_queue(const char *name, struct slurm_task **tasks, size_t *count,
                        struct error *error);

/* Cancels what is left of the arrays of this name. error may be NULL, here and below. */
enum status slurm_cancel(const char *name, struct error *error);

/* Cancels a task that Slurm holds. */
enum status slurm_cancel_task(const struct slurm_task *task, struct error *error);

/* Submits some of the `of` shares; which: their numbers, 1,3-5; name: of the array; folder: of the
 * logs; *job: the number of the array. */
enum status slurm_share_submit(const struct slurm_work *work, int of, const char *which,
                               const char *name, const char *folder, long *job,
                               struct error *error);

/* The file to which the task of a share writes its output. */
void slurm_share_log(const char *folder, const char *name, long job, int share, char *path,
                     size_t size);
