/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_job.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cache.h"
#include "result.h"
#include "run_output.h"

char *run_job_key(const struct run *run, const char *kind, struct error *error)
{
    const struct case_file *file = &run->asked.file;
    json_t *key = result_object("kind=%s case=%s title=%s dimension=%d any_window=%d? settings=%p",
                                kind, file->name, file->title, file->dimension,
                                run->asked.any_window, (void *)settings_json(&run->settings));
    /* the content of a particle file decides the result, not its name alone */
    if (key && run->settings.file[0])
        json_object_set_new(key, "content",
                            json_integer((json_int_t)cache_hash_file(run->settings.file)));
    const struct run_external *external = run->asked.external;
    if (key && external && external->add_key(external, run, key, error)) {
        json_decref(key);
        return NULL;
    }
    char *text =
        key ? json_dumps(key, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(key);
    if (!text) error_set(error, STATUS_ENVIRONMENT, "no memory for a run's key");
    return text;
}

/* Assumes that every step updates all particles, and that the number of steps is proportional to
 * the particles in a row of the box. */
double run_job_weight(const struct run *run)
{
    const double n = settings_real(&run->settings, SETTING_n);
    const int dim = run->asked.file.dimension;
    return 0.002 + (dim == 1 ? 5e-8 : 1e-5) * pow(n, 1 + 1. / dim);
}

enum status run_job_external(const struct run *run, bool profile, json_t **document,
                             struct error *error)
{
    const struct run_external *external = run->asked.external;
    pool_end_with_parent();
    return external->compute(external, run, profile, document, error);
}

static enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct run *run = context;
    struct run_result result;
    if (run->asked.external) return run_job_external(run, false, document, error);
    const enum status status = run_execute(run, &result, error);
    if (status != STATUS_OK && status != STATUS_BROKE_DOWN) return status;
    *document = result_new("run");
    run_add_json(&run->asked, &result, *document);
    run_free(&result);
    return status;
}

enum status run_job_add(struct pool *pool, const struct run *run, size_t *job, struct error *error)
{
    char name[128];
    char *key = run_job_key(run, RUN_JOB_PROFILE, error);
    if (!key) return error->status;
    *job = pool_find(pool, key);
    free(key);
    if (*job != (size_t)-1) return STATUS_OK;
    if (!(key = run_job_key(run, "run", error))) return error->status;
    snprintf(name, sizeof name, "%s, n = %.10g", run->asked.file.name,
             settings_real(&run->settings, SETTING_n));
    *job = pool_add(pool, name, key, run_job_weight(run), compute, run);
    free(key);
    if (*job != (size_t)-1) pool->jobs[*job].fickle = run->asked.external != NULL;
    return *job == (size_t)-1 ? error_set(error, STATUS_ENVIRONMENT, "no memory for a run")
                              : STATUS_OK;
}
