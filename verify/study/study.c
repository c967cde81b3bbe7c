/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "functional.h"
#include "measure.h"
#include "problem_list.h"
#include "run_job.h"
#include "value.h"

/* An order lost to the lattice sums shows a relative error of this many floors at most. */
static const double floor_reach = 20;

const char *const study_part_names[STUDY_PARTS] = {"azimuthal", "radial"};

bool study_is_random(const struct settings *settings)
{
    return problem_of(settings)->random(settings);
}

size_t study_replicates(const struct run_settings *settings)
{
    if (study_is_random(&settings->settings)) return 3;
    return settings->file.dimension > 1 || problem_of(&settings->settings)->smooth ? 1 : 9;
}

size_t study_neighbour(size_t n, size_t replicates, size_t r)
{
    if (replicates < 2) return n;
    const size_t step = (size_t)fmax(1, round(0.05 * (double)n / (double)(replicates - 1)));
    const size_t away = (r + 1) / 2 * step, most = replicates / 2 * step;
    if (n < most + 4) return n + r * step; /* the least that a run can have is 4 */
    return r % 2 ? n + away : n - away;
}

/* ---- planning ---- */

static struct run *run_at(const struct study *study, size_t combination, size_t level, size_t r)
{
    return &study->runs[(combination * study->level_count + level) * study->replicates + r];
}

static size_t job_at(const struct study *study, size_t combination, size_t level, size_t r)
{
    return study->jobs[run_at(study, combination, level, r) - study->runs];
}

static enum status set_integer(struct run_settings *settings, enum setting key, double value,
                               struct error *error)
{
    char text[32];
    snprintf(text, sizeof text, "%.0f", value);
    return settings_set(&settings->settings, key, text, SOURCE_USER, NULL, error);
}

/* What no level could run is said before anything runs. */
static enum status try_coarsest(const struct run *run, struct error *error)
{
    struct run_result *plan = malloc(sizeof *plan);
    if (!plan) return error_set(error, STATUS_ENVIRONMENT, "no memory for a study");
    const enum status status = run_explain(run, plan, error);
    free(plan);
    return status;
}

/* The runs of a combination, resolved. */
static enum status make_runs(struct study *study, size_t c, const struct run_settings *base,
                             struct error *error)
{
    const double seed = settings_real(&base->settings, SETTING_seed);
    const bool random = study_is_random(&base->settings);
    for (size_t l = 0; l < study->level_count; l++)
        for (size_t r = 0; r < study->replicates; r++) {
            struct run_settings asked = *base;
            const size_t n =
                random ? study->ladder[l] : study_neighbour(study->ladder[l], study->replicates, r);
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
        const bool refused = reason.status == STATUS_CHECK_FAILED; /* a plug-in: no combination */
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
    size_t excluded = 0;
    for (size_t c = 0; c < study->sweep.count; c++) {
        if (plan_combination(study, c, pool, error)) return error->status;
        excluded += study->results[c].excluded;
    }
    if (excluded == study->sweep.count)
        return error_set(error, STATUS_BAD_INPUT, "no combination of --vary is allowed: %.400s",
                         study->results[0].message);
    return STATUS_OK;
}

void study_free(struct study *study)
{
    free(study->results);
    free(study->runs);
    free(study->jobs);
    study->results = NULL;
    study->runs = NULL;
    study->jobs = NULL;
}

/* ---- reading the runs ---- */

static double norm_of(const json_t *run, const char *what, int norm)
{
    const json_t *fields = json_object_get(run, "errors");
    return value_member(json_object_get(fields, what), field_norm_family.members[norm]->name);
}

static double error_of(const json_t *run, int field, int norm)
{
    return norm_of(run, field_family.members[field]->name, norm);
}

static void read_functionals(struct study_result *result, struct study_level *level,
                             const json_t *run, double weight)
{
    const json_t *entry;
    size_t i;
    json_array_foreach(json_object_get(run, "functionals"), i, entry)
    {
        if (i == PROBLEM_FUNCTIONALS_MAX) break;
        result->functional_names[i] = problem_functional_name(value_text(entry, "name"));
        level->functionals[i] += weight * value_member(entry, "value");
        result->functional_exact[i] = value_member(entry, "reference");
    }
    result->functional_count = i;
}

/* Means of squares and products over the replicates of a level: x = log(spacing), y = log(error).
 */
struct moments {
    double xx, xy[FIELDS][NORMS], yy[FIELDS][NORMS];
};

static void read_run(struct study_result *result, struct study_level *level,
                     struct moments *moments, const json_t *run, double weight)
{
    const size_t n = (size_t)value_member(run, "n");
    const double x = log(value_member(run, "spacing"));
    if (!level->n) level->n = level->n_range[0] = level->n_range[1] = n;
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
    budget_add(&level->budget, problem_of(&result->settings)->regions,
               json_object_get(run, "budget"), weight);
    read_functionals(result, level, run, weight);
    const char *suspicion = value_text(run, "suspicion");
    if (*suspicion && !result->suspicion[0])
        snprintf(result->suspicion, sizeof result->suspicion, "%s", suspicion);
}

/* From means of logarithms to geometric means; a single run keeps its own bits. */
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

/* The spreads of sound levels. Replicates with other n have another error, too: what they scatter
 * is measured about a line of the slope that the whole ladder has. */
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
                level->spread[f][m] = sqrt(freedom * (squares < 0 ? 0 : squares));
            }
        }
}

/* Levels in order, up to the first that broke down. */
static enum status read_levels(struct study *study, size_t c, const struct pool *pool,
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

/* ---- judging ---- */

static enum status fit_orders(const struct study *study, struct study_result *result,
                              struct error *error)
{
    double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX], variance[CASE_LADDER_MAX];
    const struct order_noise noise = {variance, study->replicates};
    const size_t n = result->level_count;
    for (size_t l = 0; l < n; l++) spacing[l] = result->levels[l].spacing;
    for (int f = 0; f < FIELDS; f++)
        for (int m = 0; m < NORMS; m++) {
            for (size_t l = 0; l < n; l++) {
                const double spread = result->levels[l].spread[f][m];
                errors[l] = result->levels[l].errors[f][m];
                variance[l] = spread * spread / (double)study->replicates;
            }
            if (order_fit(n, spacing, errors, study->replicates > 1 ? &noise : NULL,
                          &result->orders[f][m].fit, error))
                return error->status;
        }
    const struct regions *regions = result->levels[0].budget.regions;
    for (size_t r = 0; regions && regions->names[r]; r++) {
        bool everywhere = true;
        for (size_t l = 0; l < n; l++) {
            errors[l] = result->levels[l].budget.l1[r][FIELD_DENSITY];
            everywhere = everywhere && errors[l] > 0;
        }
        if (everywhere && order_fit(n, spacing, errors, NULL, &result->regions[r], error))
            return error->status;
    }
    return STATUS_OK;
}

/* Of what only 2D and 3D have: parts of the velocity, and functionals that are known exactly. (In
 * 1D a mean's error goes through 0, and has no order.) */
static enum status fit_cloud_orders(struct study_result *result, struct error *error)
{
    double spacing[CASE_LADDER_MAX], errors[CASE_LADDER_MAX];
    const size_t n = result->level_count;
    for (size_t l = 0; l < n; l++) spacing[l] = result->levels[l].spacing;
    for (int part = 0; part < STUDY_PARTS; part++) {
        for (size_t l = 0; l < n; l++) errors[l] = result->levels[l].parts[part][NORM_L1_CUT];
        if (isfinite(errors[0]) && order_fit(n, spacing, errors, NULL, &result->parts[part], error))
            return error->status;
    }
    for (size_t i = 0; i < result->functional_count; i++) {
        const double exact = result->functional_exact[i];
        for (size_t l = 0; l < n; l++) errors[l] = fabs(result->levels[l].functionals[i] - exact);
        if (isfinite(exact) &&
            order_fit(n, spacing, errors, NULL, &result->functional_errors[i], error))
            return error->status;
    }
    return STATUS_OK;
}

static void extrapolate(struct study_result *result)
{
    const struct study_level *last = &result->levels[result->level_count - 3];
    const double spacing[3] = {last[0].spacing, last[1].spacing, last[2].spacing};
    for (size_t i = 0; i < result->functional_count; i++) {
        const double values[3] = {last[0].functionals[i], last[1].functionals[i],
                                  last[2].functionals[i]};
        result->functionals[i] = order_extrapolate(spacing, values, result->functional_exact[i]);
    }
}

static void judge_gates(struct study_result *result, const struct case_file *file)
{
    const struct study_level *finest = &result->levels[result->level_count - 1];
    const bool standard = result->scheme.gradient == GRADIENT_STANDARD;
    measure_lattice(&result->scheme.kernel, file->dimension, result->scheme.eta,
                    &result->floor_density, &result->floor_gradient);
    const double floor =
        fmax(fabs(result->floor_density), standard ? fabs(result->floor_gradient) : 0);
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        struct study_order *order = &result->orders[gate->field][gate->norm];
        order->gate = gate->gate;
        if (file->ladder_count) {
            const double coarser = (double)file->ladder[file->ladder_count - 1] / (double)finest->n;
            order->gate.bound *= pow(fmax(1, coarser), gate->gate.low / file->dimension);
        }
        order->status = order_passes(&order->fit, &order->gate, order->why) ? GATE_PASS : GATE_FAIL;
        order->known = gate->known;
        if (order->status == GATE_FAIL && *gate->known) order->status = GATE_KNOWN;
        if (order->status != GATE_FAIL) continue;
        result->status = STATUS_CHECK_FAILED;
        result->floor_explains |= !(order->fit.order >= order->gate.low) &&
                                  finest->errors[gate->field][gate->norm] <= floor_reach * floor;
    }
}

/* Gas that no wave has reached: noise that was put there is none of its own. */
static void judge_stillness(struct study_result *result)
{
    result->still = NAN;
    for (size_t l = 0; l < result->level_count; l++)
        if (result->levels[l].budget.regions)
            result->still = fmax(result->still, result->levels[l].budget.still);
    if (isnan(result->still) || study_is_random(&result->settings)) return;
    result->still_status = result->still <= STUDY_STILL_BOUND ? GATE_PASS : GATE_FAIL;
    if (result->still_status == GATE_FAIL) result->status = STATUS_CHECK_FAILED;
}

static void suspect(struct study_result *result, const struct case_file *file)
{
    double errors[CASE_LADDER_MAX];
    char why[SUSPICION_TEXT];
    for (int field = 0; field < FIELDS && !result->suspicion[0]; field++) {
        if (file->exact[field] || problem_of(&result->settings)->fieldless) continue;
        for (size_t i = 0; i < result->level_count; i++)
            errors[i] = result->levels[i].errors[field][NORM_L1];
        if (suspicion_zero(result->level_count, errors, why) ||
            suspicion_repeated(result->level_count, errors, why))
            snprintf(result->suspicion, sizeof result->suspicion, "%s: %.160s",
                     field_family.members[field]->name, why);
    }
    if (result->suspicion[0]) result->status = STATUS_CHECK_FAILED;
}

/* ---- settings without effect ---- */

/* Does alpha vary by a switch, between alpha_min and alpha_max? */
static bool is_switched(int viscosity)
{
    return viscosity == VISCOSITY_TIME_DEPENDENT || viscosity == VISCOSITY_CULLEN_DEHNEN;
}

/* Do these settings say anything to the solver that the key could change? `skip` must not. */
static bool is_read(enum setting key, const struct settings *settings)
{
    const int viscosity = settings_choice(settings, SETTING_viscosity);
    const int kernel = settings_choice(settings, SETTING_kernel);
    switch (key) {
    case SETTING_skip:
        return false;
    case SETTING_sinc_n:
        return strcmp(kernel_family.members[kernel]->name, "sinc") == 0;
    case SETTING_alpha:
    case SETTING_beta:
        return viscosity != VISCOSITY_NONE && !is_switched(viscosity);
    case SETTING_alpha_min:
    case SETTING_alpha_max:
        return is_switched(viscosity);
    case SETTING_seed:
        return study_is_random(settings);
    case SETTING_grade_ratio:
        return settings_real(settings, SETTING_grade) < 1;
    case SETTING_h_tolerance:
        return settings_choice(settings, SETTING_h_method) == H_NEWTON;
    default:
        return true;
    }
}

bool study_suspect_same(const char *what, const struct study_result *a,
                        const struct study_result *b, char *why)
{
    double before[CASE_LADDER_MAX * FIELDS], after[CASE_LADDER_MAX * FIELDS];
    size_t n = 0;
    for (size_t l = 0; l < a->level_count && l < b->level_count; l++)
        for (int f = 0; f < FIELDS; f++, n++) {
            before[n] = a->levels[l].errors[f][NORM_L1];
            after[n] = b->levels[l].errors[f][NORM_L1];
        }
    return suspicion_idle_setting(what, n, before, after, why);
}

/* Every pair of combinations that differ in one key only and should have differed in their results:
 * suspicious where none of a key's pairs does. */
static void suspect_idle(struct study *study)
{
    size_t stride = study->sweep.count;
    for (size_t k = 0; k < study->sweep.key_count; k++) {
        const struct sweep_key *key = &study->sweep.keys[k];
        char why[SUSPICION_TEXT] = "";
        size_t pairs = 0, same = 0;
        stride /= key->count;
        for (size_t c = 0; c < study->sweep.count; c++) {
            const struct study_result *a = &study->results[c], *b = a + stride;
            if ((c / stride) % key->count == key->count - 1) continue;
            if (a->excluded || b->excluded || !is_read(key->key, &a->settings) ||
                !is_read(key->key, &b->settings))
                continue;
            pairs++;
            same += study_suspect_same(setting_keys[key->key].name, a, b, why);
        }
        if (!pairs || same < pairs) continue;
        memcpy(study->suspicion, why, sizeof study->suspicion);
        study->status = STATUS_CHECK_FAILED;
    }
}

enum status study_judge(struct study *study, const struct pool *pool, struct error *error)
{
    for (size_t c = 0; c < study->sweep.count; c++) {
        struct study_result *result = &study->results[c];
        if (result->excluded) continue;
        if (read_levels(study, c, pool, error)) return error->status;
        if (result->status == STATUS_OK) {
            if (fit_orders(study, result, error) ||
                (study->settings.file.dimension > 1 && fit_cloud_orders(result, error)))
                return error->status;
            extrapolate(result);
            judge_gates(result, &study->settings.file);
            judge_stillness(result);
            suspect(result, &study->settings.file);
        }
        if (result->status > study->status) study->status = result->status;
    }
    suspect_idle(study);
    return STATUS_OK;
}
