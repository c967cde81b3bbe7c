/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs as jobs of a pool: their cache key and their document. */
#pragma once

#include "pool.h"
#include "run.h"

/* Everything that decides a run's result as text: case, dimension and all settings used. kind
 * distinguishes what is computed. Malloced; NULL with error: no memory. */
char *run_job_key(const struct run *run, const char *kind, struct error *error);

/* The kind of a run with its profile, which can replace a plain run. */
#define RUN_JOB_PROFILE "profile"

/* Estimated seconds of a run. */
double run_job_weight(const struct run *run);

/* Adds the run, which must outlive the pool, unless the pool has it with its profile. The document
 * is that of `sphproof run`. */
enum status run_job_add(struct pool *pool, const struct run *run, size_t *job, struct error *error);

/* Called within a job of a pool: makes the document of another program's run,
 * run->asked.external. */
enum status run_job_external(const struct run *run, bool profile, json_t **document,
                             struct error *error);
