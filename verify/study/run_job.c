/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_job.h"

#include <stdio.h>
#include <stdlib.h>

#include "result.h"

char *run_job_key(const struct run_settings *settings, const char *kind, struct error *error)
{
    struct settings resolved = settings->settings;
    struct scheme scheme;
    if (settings_resolve(&resolved, settings->file.dimension, &scheme, error)) return NULL;
    json_t *key =
        json_pack("{s:s, s:s, s:s, s:i, s:b, s:o}", "kind", kind, "case", settings->file.name,
                  "title", settings->file.title, "dimension", settings->file.dimension,
                  "any_window", settings->any_window, "settings", settings_json(&resolved));
    char *text =
        key ? json_dumps(key, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17)) : NULL;
    json_decref(key);
    if (!text) error_set(error, STATUS_ENVIRONMENT, "no memory for a run's key");
    return text;
}

double run_job_weight(const struct run_settings *settings)
{
    const double n = settings_real(&settings->settings, SETTING_n);
    return 0.002 + 5e-8 * n * n;
}

static enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct run_settings *settings = context;
    struct run_result result;
    const enum status status = run_execute(settings, &result, error);
    if (status != STATUS_OK && status != STATUS_BROKE_DOWN) return status;
    *document = result_new("run");
    run_add_json(settings, &result, *document);
    run_free(&result);
    return status;
}

enum status run_job_add(struct pool *pool, const struct run_settings *settings, size_t *job,
                        struct error *error)
{
    char name[128];
    char *key = run_job_key(settings, "run", error);
    if (!key) return error->status;
    snprintf(name, sizeof name, "%s, n = %.10g", settings->file.name,
             settings_real(&settings->settings, SETTING_n));
    *job = pool_add(pool, name, key, run_job_weight(settings), compute, settings);
    free(key);
    return *job == (size_t)-1 ? error_set(error, STATUS_ENVIRONMENT, "no memory for a run")
                              : STATUS_OK;
}
