/* SPDX-License-Identifier: GPL-3.0-or-later
 * Engines that compute many jobs: a family. An engine fills the cache; the pool runs afterwards,
 * takes the results from there and computes the rest. */
#pragma once

#include "command.h"
#include "pool.h"
#include "progress.h"

enum { ENGINE_TASKS_MAX = 1000 }; /* Slurm's usual MaxArraySize, less one */

/* The work of an engine. Nothing is owned. */
struct engine_work {
    const struct options *options; /* of the command line; a share's command line is made from it */
    const struct pool *pool;
    const struct cache *cache;
    int jobs;  /* processes of a share */
    int tasks; /* shares; 0: about ten minutes of work each */
    struct progress *progress;
};

struct engine {
    const char *name, *label;
    /* Computes all jobs with a key, in shares, into the cache. NULL: leaves all to the pool.
     * STATUS_ENVIRONMENT: some results are missing; the others are kept. */
    enum status (*compute)(const struct engine_work *work, struct error *error);
};

#define ENGINE(name) extern const struct engine engine_##name;
#include "engines.def"
#undef ENGINE

/* The engine called name; NULL with error: there is none. */
const struct engine *engine_find(const char *name, struct error *error);
