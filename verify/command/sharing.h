/* SPDX-License-Identifier: GPL-3.0-or-later
 * Options of all commands with many independent computations: number of processes, cache, share of
 * this process, and the list of computations. */
#pragma once

#include "command.h"
#include "pool.h"
#include "slurm.h"

/* Each command lists --jobs itself, because the defaults differ. */
#define SHARING_OPTIONS                                                                            \
    {"cache", "DIR", "keep results there, and do not repeat computations that it has"},            \
        SHARING_OPTIONS_OF_CACHE
/* For a command that chooses the folder of its cache. */
#define SHARING_OPTIONS_OF_CACHE                                                                   \
    {"shard", "I/N",                                                                               \
     "compute only the Ith of N equal shares, into the cache; a call without --shard then "        \
     "collects all of them"},                                                                      \
        {"only-build", "ID",                                                                       \
         "refuse to compute unless results of this program are those of that build"},              \
        {"engine", "local|slurm",                                                                  \
         "who computes: this machine (default), or a cluster by an array job of sbatch"},          \
        {"engine-options", COMMAND_OPTIONS,                                                        \
         "passed to sbatch, for example \"--partition=main --time=2:00:00\""},                     \
        {"engine-tasks", "N",                                                                      \
         "number of tasks in the array (default: each gets ten minutes of work or more)"},         \
    {                                                                                              \
        "list", NULL,                                                                              \
            "compute nothing; print a line for each computation: estimated seconds, share, kept "  \
            "or -, name, with tabs between"                                                        \
    }

struct sharing {
    bool list;
    bool slurm;                /* a cluster computes */
    int tasks;                 /* number of its tasks; 0: it decides */
    struct pool_settings pool; /* sharing_run sets its progress */
    struct cache cache;        /* used if pool.cache is not NULL */
    struct progress progress;
};

/* Reads the options. jobs: default of --jobs, 0: one; folder: of the cache, NULL: that of --cache.
 * Without --engine slurm and --shard, --force computes again what the cache has.
 * STATUS_BAD_INPUT: an option is wrong, or --shard is used without a cache. sharing must not move
 * in memory afterwards. */
enum status sharing_take(struct sharing *sharing, const struct options *options, int jobs,
                         const char *folder, struct error *error);

/* Runs the pool with a line of progress and prints remarks. With --shard prints what the share has
 * computed; with --list only lists the computations. *whole: all results are there to be judged.
 */
enum status sharing_run(struct sharing *sharing, struct pool *pool, const struct options *options,
                        bool *whole, struct error *error);
