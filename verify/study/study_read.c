/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study.h"

#include <math.h>
#include <stdio.h>

#include "problem_list.h"
#include "value.h"

static size_t job_at(const struct study *study, size_t combination, size_t level, size_t r)
{
    return study->jobs[(combination * study->level_count + level) * study->replicates + r];
}

static double norm_of(const json_t *run, const char *what, int norm)
{
    const json_t *fields = json_object_get(run, "errors");
    return value_member(json_object_get(fields, what), field_norm_family.members[norm]->name);
}

static double error_of(const json_t *run, int field, int norm)
{
    return norm_of(run, field_family.members[field]->name, norm);
}

/* Adds weight times the budget of a run by these regions (NULL: none); still: the maximum. */
static void add_budget(struct budget *budget, const struct regions *regions, const json_t *json,
                       double weight)
{
    if (!regions || !json_is_object(json)) return;
    if (!budget->regions) *budget = (struct budget){.regions = regions, .still = NAN};
    for (size_t r = 0; regions->names[r]; r++)
        for (int f = 0; f < FIELDS; f++)
            budget->l1[r][f] +=
                weight * value_inner(json, regions->names[r], field_family.members[f]->name);
    budget->still = fmax(budget->still, value_member(json, "still"));
}

static void read_functionals(struct study_result *result, struct study_level *level,
                             const json_t *run, double weight)
{
    const json_t *entry;
    size_t i;
    json_array_foreach(json_object_get(run, "functionals"), i, entry) {
        if (i == PROBLEM_FUNCTIONALS_MAX) break;
        result->functional_names[i] = problem_functional_name(value_text(entry, "name"));
        level->functionals[i] += weight * value_member(entry, "value");
        result->functional_exact[i] = value_member(entry, "reference");
    }
    result->functional_count = i;
}

/* Keeps the worst replicate; first: there is no earlier one. */
static void read_kept(struct study_level *level, const json_t *conservation, bool first)
{
    for (size_t k = 0; k < TRACE_FIGURES; k++) {
        const double value = value_member(conservation, trace_figures[k]);
        if (first || isnan(value) || value > level->kept[k]) level->kept[k] = value;
    }
}

/* Means of squares and products over the replicates of a level; x = log(spacing), y =
 * log(error). */
struct moments {
    double xx, xy[FIELDS][NORMS], yy[FIELDS][NORMS];
};

static void read_run(struct study_result *result, struct study_level *level,
                     struct moments *moments, const json_t *run, double weight)
{
    const size_t n = (size_t)value_member(run, "n");
    const double x = log(value_member(run, "spacing"));
    read_kept(level, json_object_get(run, "conservation"), !level->n);
    if (!level->n) level->n = level->n_range[0] = n;
    if (n < level->n_range[0]) level->n_range[0] = n;
    if (n > level->n_range[1]) level->n_range[1] = n;
    level->spacing += weight * x;
    level->h += weight * value_member(run, "h");
    moments->xx += weight * x * x;
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++) {
            const double y = log(error_of(run, f, m));
            level->errors[f][m] += weight * y;
            moments->xy[f][m] += weight * x * y;
            moments->yy[f][m] += weight * y * y;
        }
    for (int part = 0; part < STUDY_PARTS; part++)
        for (int m = 0; m < NORMS; m++)
            level->parts[part][m] += weight * log(norm_of(run, study_part_names[part], m));
    level->binned_density_l1 +=
        weight * log(value_member(json_object_get(run, "errors"), "binned_density_l1"));
    level->cpu_s += weight * value_member(json_object_get(run, "cost"), "cpu_s");
    add_budget(&level->budget, problem_of(&result->settings)->regions,
               json_object_get(run, "budget"), weight);
    read_functionals(result, level, run, weight);
    const json_t *errors = json_object_get(run, "errors");
    for (int f = 0; f < FIELDS; f++)
        result->interpolation[f] =
            value_member(json_object_get(errors, "interpolation"), field_family.members[f]->name);
    const char *suspicion = value_text(run, "suspicion");
    if (*suspicion && !result->suspicion[0])
        snprintf(result->suspicion, sizeof result->suspicion, "%s", suspicion);
}

/* Turns means of logarithms into geometric means; a single run keeps its own bits. */
static void close_level(struct study_level *level, const json_t *first, size_t replicates)
{
    const bool single = replicates == 1;
    level->spacing = single ? value_member(first, "spacing") : exp(level->spacing);
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++)
            level->errors[f][m] = single ? error_of(first, f, m) : exp(level->errors[f][m]);
    for (int part = 0; part < STUDY_PARTS; part++)
        for (int m = 0; m < NORMS; m++)
            level->parts[part][m] =
                single ? norm_of(first, study_part_names[part], m) : exp(level->parts[part][m]);
    level->binned_density_l1 =
        single ? value_member(json_object_get(first, "errors"), "binned_density_l1")
               : exp(level->binned_density_l1);
}

/* Finds the spreads of sound levels. Replicates with different n have different errors, so their
 * scatter is measured about a line with the slope of the whole ladder. */
static void find_spreads(struct study_result *result, const struct moments *moments,
                         size_t replicates)
{
    const struct study_level *coarsest = &result->levels[0],
                             *finest = &result->levels[result->level_count - 1];
    const double freedom = (double)replicates / (double)(replicates - 1);
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++) {
            const double slope = log(coarsest->errors[f][m] / finest->errors[f][m]) /
                                 log(coarsest->spacing / finest->spacing);
            const double p = isfinite(slope) ? slope : 0;
            for (size_t l = 0; l < result->level_count; l++) {
                struct study_level *level = &result->levels[l];
                const double x = log(level->spacing), y = log(level->errors[f][m]);
                const double squares = moments[l].yy[f][m] - y * y -
                                       2 * p * (moments[l].xy[f][m] - x * y) +
                                       p * p * (moments[l].xx - x * x);
                level->spread[f][m] = sqrt(freedom * fmax(0, squares));
            }
        }
}

enum status study_read_levels(struct study *study, size_t c, const struct pool *pool,
                              struct error *error)
{
    struct study_result *result = &study->results[c];
    struct moments moments[CASE_LADDER_MAX] = {0};
    for (size_t l = 0; l < study->level_count; l++) {
        struct study_level *level = &result->levels[l];
        for (size_t r = 0; r < study->replicates; r++) {
            const struct pool_job *job = &pool->jobs[job_at(study, c, l, r)];
            if (job->error.status == STATUS_BROKE_DOWN) {
                result->status = STATUS_BROKE_DOWN;
                snprintf(result->message, sizeof result->message, "n = %zu: %.480s",
                         study->ladder[l], job->error.message);
                return STATUS_OK;
            }
            if (job->error.status || !job->document)
                return error_set(error, job->error.status ? job->error.status : STATUS_ENVIRONMENT,
                                 "%s", job->error.message);
            read_run(result, level, &moments[l], job->document, 1 / (double)study->replicates);
        }
        close_level(level, pool->jobs[job_at(study, c, l, 0)].document, study->replicates);
        result->level_count++;
    }
    if (study->replicates > 1) find_spreads(result, moments, study->replicates);
    return STATUS_OK;
}
