/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "problem_list.h"
#include "run_job.h"

const char *const study_part_names[STUDY_PARTS] = {"azimuthal", "radial"};

size_t study_replicates(const struct run_settings *settings)
{
    const struct settings *s = &settings->settings;
    const bool dear = settings->file.dimension > 1 && s->value[SETTING_jitter].automatic &&
                      settings_choice(s, SETTING_lattice) == LATTICE_JITTERED;
    if (settings_random_start(s) && !dear) return 3;
    return settings->file.dimension > 1 || problem_of(s)->smooth ? 1 : 9;
}

size_t study_neighbour(size_t n, int dim, size_t replicates, size_t least, size_t r)
{
    if (replicates < 2) return n;
    if (dim > 1) {
        const double side = round(pow((double)n, 1. / dim)), away = (double)((r + 1) / 2);
        const double wanted = fmax(0, r % 2 ? side + away : side - away);
        return (size_t)round((double)n * pow(wanted / side, dim));
    }
    const size_t step =
        (size_t)fmax((double)least, round(0.05 * (double)n / (double)(replicates - 1)));
    const size_t away = (r + 1) / 2 * step, most = replicates / 2 * step;
    if (n < most + 4) return n + r * step; /* a run has at least 4 */
    return r % 2 ? n + away : n - away;
}

static struct run *run_at(const struct study *study, size_t combination, size_t level, size_t r)
{
    return &study->runs[(combination * study->level_count + level) * study->replicates + r];
}

static enum status set_integer(struct run_settings *settings, enum setting key, double value,
                               struct error *error)
{
    char text[32];
    snprintf(text, sizeof text, "%.0f", value);
    return settings_set(&settings->settings, key, text, SOURCE_USER, NULL, error);
}

/* Refuses settings that no level could run, before any run starts. */
static enum status try_coarsest(const struct run *run, struct error *error)
{
    struct run_result *plan = malloc(sizeof *plan);
    if (!plan) return error_set(error, STATUS_ENVIRONMENT, "no memory for a study");
    const enum status status = run_explain(run, plan, error);
    free(plan);
    return status;
}

/* Resolves the runs of a combination. */
static enum status make_runs(struct study *study, size_t c, const struct run_settings *base,
                             struct error *error)
{
    const double seed = settings_real(&base->settings, SETTING_seed);
    const bool random = settings_random_start(&base->settings);
    for (size_t l = 0; l < study->level_count; l++)
        for (size_t r = 0; r < study->replicates; r++) {
            struct run_settings asked = *base;
            const size_t n = random ? study->ladder[l]
                                    : study_neighbour(study->ladder[l], base->file.dimension,
                                                      study->replicates, 1, r);
            if (set_integer(&asked, SETTING_n, (double)n, error) ||
                (r && random && set_integer(&asked, SETTING_seed, seed + (double)r, error)) ||
                run_resolve(run_at(study, c, l, r), &asked, error))
                return error->status;
        }
    return STATUS_OK;
}

static enum status plan_combination(struct study *study, size_t c, struct pool *pool,
                                    struct error *error)
{
    struct study_result *result = &study->results[c];
    struct run_settings base = study->settings;
    struct error reason = {0};
    if (sweep_apply(&study->sweep, c, &base, error)) return error->status;
    if (make_runs(study, c, &base, &reason)) {
        const bool refused =
            reason.status == STATUS_CHECK_FAILED; /* a refused plug-in fails the whole study */
        if (study->sweep.count == 1 || refused)
            return error_set(error, reason.status, "%s", reason.message);
        result->excluded = true;
        memcpy(result->message, reason.message, sizeof result->message);
        return STATUS_OK;
    }
    const struct run *finest = run_at(study, c, study->level_count - 1, 0);
    result->settings = finest->settings;
    result->scheme = finest->scheme;
    if (try_coarsest(run_at(study, c, 0, 0), error)) return error->status;
    for (size_t l = 0; l < study->level_count; l++)
        for (size_t r = 0; r < study->replicates; r++) {
            const struct run *run = run_at(study, c, l, r);
            if (run_job_add(pool, run, &study->jobs[run - study->runs], error))
                return error->status;
        }
    return STATUS_OK;
}

enum status study_plan(struct study *study, struct pool *pool, struct error *error)
{
    const size_t runs = study->sweep.count * study->level_count * study->replicates;
    study->results = calloc(study->sweep.count, sizeof *study->results);
    study->runs = calloc(runs, sizeof *study->runs);
    study->jobs = calloc(runs, sizeof *study->jobs);
    if (!study->results || !study->runs || !study->jobs)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a study of %zu runs", runs);
    size_t allowed = 0;
    struct settings left;
    for (size_t c = 0; c < study->sweep.count; c++) {
        if (plan_combination(study, c, pool, error)) return error->status;
        if (study->results[c].excluded) continue;
        if (allowed++ == 0) left = study->results[c].settings;
        settings_take_used(&study->results[c].settings, &left);
    }
    if (!allowed)
        return error_set(error, STATUS_BAD_INPUT, "no combination of --vary is allowed: %.400s",
                         study->results[0].message);
    return study->settings.settings.shared ? STATUS_OK : settings_refuse_unused(&left, error);
}

void study_free(struct study *study)
{
    free(study->results);
    free(study->runs);
    free(study->jobs);
    study->results = NULL, study->runs = NULL, study->jobs = NULL;
}
