/* SPDX-License-Identifier: GPL-3.0-or-later
 * Who computes what many computations consist of: a family. An engine fills the cache; the pool,
 * which runs afterwards, finds everything there, or computes it where an engine leaves it to it. */
#pragma once

#include "command.h"
#include "pool.h"
#include "progress.h"

enum { ENGINE_TASKS_MAX = 1000 }; /* Slurm's usual MaxArraySize, less one */

/* What is to be done, and with what. Nothing is owned. */
struct engine_work {
    const struct options *options; /* of the command line, from which that of a share is made */
    const struct pool *pool;
    const struct cache *cache;
    int jobs;  /* processes of a share */
    int tasks; /* shares; 0: as many as are ten minutes' work each */
    struct progress *progress;
};

struct engine {
    const char *name, *label;
    /* Computes all that has a key, in shares, into the cache. NULL: leaves everything to the pool.
     * STATUS_ENVIRONMENT: not all is there; what is there stays. */
    enum status (*compute)(const struct engine_work *work, struct error *error);
};

#define ENGINE(name) extern const struct engine engine_##name;
#include "engines.def"
#undef ENGINE

/* The engine called name; NULL with error: there is none. */
const struct engine *engine_find(const char *name, struct error *error);
