/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs as jobs of a pool: the key that decides a run's result, and what it leaves behind. */
#pragma once

#include "pool.h"
#include "run.h"

/* All that decides the result of a run, as text: case, dimension and every setting as used. kind
 * tells apart what is computed from it. Malloced; NULL with error: no memory. */
char *run_job_key(const struct run *run, const char *kind, struct error *error);

/* The kind of a run with its profile: more than a run, so that it stands for one. */
#define RUN_JOB_PROFILE "profile"

/* About how many seconds a run takes. */
double run_job_weight(const struct run *run);

/* Adds the run, which must outlive the pool, unless it is there with its profile already. Its
 * document is that of `sphproof run`. */
enum status run_job_add(struct pool *pool, const struct run *run, size_t *job, struct error *error);

/* In a job of a pool: the document that another program computes, run->asked.external. */
enum status run_job_external(const struct run *run, bool profile, json_t **document,
                             struct error *error);
