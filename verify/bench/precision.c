/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "precision.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "judged.h"
#include "plain.h"
#include "problem_list.h"
#include "result.h"
#include "run_job.h"
#include "study.h"
#include "value.h"

static void release_plain(void *owned)
{
    plain_free(owned);
    free(owned);
}

void precision_plain(const struct setup *setup, struct run_outcome *outcome)
{
    struct plain *plain = calloc(1, sizeof *plain);
    if (!plain) {
        outcome->status = error_set(&outcome->reason, STATUS_ENVIRONMENT, "no memory for a run");
        return;
    }
    outcome->status = plain_run(plain, setup, &outcome->reason);
    outcome->start = plain->start;
    outcome->end = plain->end;
    outcome->cost = plain->cost;
    plain_snapshot(plain, &outcome->snapshot);
    outcome->owned = plain;
    outcome->release = release_plain;
}

/* The seed program's method with its errors corrected; added to the user's keys, which define the
 * problem. */
static const char *const seed_keys[] = {
    "kernel=cubic_spline",
    "eta=4.8",
    "gradient=standard",
    "formulation=vanilla_ice",
    "volume_element=mass",
    "integrator=modified_leapfrog",
    "cfl=0.3",
    "energy=internal",
    "viscosity=constant",
    "alpha=1",
    "beta=2",
    "pair_width=mean",
    "h_method=newton",
    "h_tolerance=1e-10",
    "skip=none",
};
/* In 2D and 3D: the textbook scheme. */
static const char *const textbook_keys[] = {"kernel=cubic_spline", "eta=2.4", "gradient=standard",
                                            "viscosity=constant"};
static const char *const graded_keys[] = {"grade=0.5"};
#define KEYS(list) sizeof(list) / sizeof *(list), list

/* --- one point -------------------------------------------------------------------------------- */

struct job {
    struct run run;
    struct precision_point *point;
    struct judged judged;
};

/* Reads the error that judges the case from a run's document. */
static double error_of(const json_t *document, int dim)
{
    const char *first = json_string_value(json_array_get(json_object_get(document, "measured"), 0));
    const char *name = dim == 1 || !first ? "density" : first;
    const json_t *scalar = value_named(json_object_get(document, "functionals"), name);
    return scalar ? fabs(value_member(scalar, "value") - value_member(scalar, "reference"))
                  : value_inner(json_object_get(document, "errors"), name, "l1");
}

/* Runs another code; point and taken may be NULL. */
static enum status run_other(const struct run *run, double *value, struct precision_point *point,
                             struct clock_taken *taken, struct error *error)
{
    const struct run_external *external = run->asked.external;
    json_t *document = NULL;
    const enum status status = external->compute(external, run, false, &document, error);
    if (!status) *value = error_of(document, run->asked.file.dimension);
    if (!status && point) {
        taken->wall_s += value_inner(document, "cost", "wall_s");
        taken->cpu_s += value_inner(document, "cost", "cpu_s");
        point->n = (size_t)value_member(document, "n");
        point->pairs = (double)NAN;
        point->settings = run->settings;
    }
    json_decref(document);
    return status;
}

static enum status error_at(const struct run *run, double *value, struct error *error)
{
    struct run_result result;
    if (run->asked.external) return run_other(run, value, NULL, NULL, error);
    struct judged judged = {"", (double)NAN, (double)NAN};
    const enum status status = run_execute(run, &result, error);
    if (!status) judged_of(&run->asked.file, &result, &judged);
    *value = judged.error;
    if (!status || status == STATUS_BROKE_DOWN) run_free(&result);
    return status;
}

/* Averages the error over the replicates of a study, at most five, scaled to the point's own n by
 * the case's order. The first is the timed run; the others run once. Five suffice for errors
 * compared over a factor of ten. A random start has only the point's own seed. */
static enum status average(struct job *job, int order, struct error *error)
{
    const size_t n = (size_t)settings_real(&job->run.settings, SETTING_n);
    const size_t wanted = study_replicates(&job->run.asked), most = 5;
    const size_t replicates = settings_random_start(&job->run.settings) ? 1
                              : wanted < most                           ? wanted
                                                                        : most;
    double sum = 0, squares = 0;
    for (size_t r = 0; r < replicates; r++) {
        const size_t near = study_neighbour(n, job->run.asked.file.dimension, replicates, 1, r);
        char key[40], *keys[] = {key};
        double value = job->point->error;
        struct run other;
        struct run_settings asked = job->run.asked;
        asked.solver = NULL; /* the same method, and faster */
        snprintf(key, sizeof key, "n=%zu", near);
        if (r && (settings_apply(&asked.settings, 1, keys, error) ||
                  run_resolve(&other, &asked, error) || error_at(&other, &value, error)))
            return error->status;
        const double y =
            log(value) + order * log((double)near / (double)n) / job->run.asked.file.dimension;
        sum += y / (double)replicates;
        squares += y * y / (double)replicates;
    }
    job->point->error_spread = (double)NAN;
    if (replicates < 2) return STATUS_OK;
    const double freedom = (double)replicates / (double)(replicates - 1);
    job->point->error = exp(sum);
    job->point->error_spread = sqrt(freedom * fmax(0, squares - sum * sum));
    return STATUS_OK;
}

static enum status execute(void *context, uint64_t times, struct clock_taken *taken,
                           struct error *error)
{
    struct job *job = context;
    for (uint64_t i = 0; i < times; i++) {
        struct run_result result;
        if (job->run.asked.external) {
            if (run_other(&job->run, &job->point->error, job->point, taken, error))
                return error->status;
            continue;
        }
        const enum status status = run_execute(&job->run, &result, error);
        if (status == STATUS_BROKE_DOWN) run_free(&result);
        if (status) return status;
        taken->wall_s += result.cost.wall_s;
        taken->cpu_s += result.cost.cpu_s;
        job->point->n = result.n;
        judged_of(&job->run.asked.file, &result, &job->judged);
        job->point->error = job->judged.error;
        job->point->pairs = (double)result.cost.pair_interactions;
        job->point->settings = result.settings;
        run_free(&result);
    }
    return STATUS_OK;
}

/* --- all of them ------------------------------------------------------------------------------ */

/* The case's order: the middle of its gate on L1(density), a little below 1 for shock tubes, or the
 * order implied by a gate on the error alone. */
static int order_of(const struct run_settings *settings)
{
    const struct case_file *file = &settings->file;
    for (size_t i = 0; i < file->gate_count; i++) {
        const struct case_gate *gate = &file->gates[i];
        if (gate->functional || gate->field != FIELD_DENSITY || (gate->norm != NORM_L1)) continue;
        const double low = gate->gate.low, high = gate->gate.high,
                     middle = isfinite(high) ? (low + high) / 2 : low;
        return middle > 1 ? (int)lround(middle) : 1;
    }
    return file->dimension > 1 && problem_of(&settings->settings)->smooth ? 2 : 1;
}

static enum status find_scale(const struct run_settings *settings, struct precision *precision,
                              struct error *error)
{
    struct run run;
    double means[NORM_BINS];
    precision->dim = settings->file.dimension;
    precision->order = order_of(settings);
    precision->error_of = "density";
    precision->mean_density = precision->signal = (double)NAN;
    if (precision->dim > 1) return STATUS_OK; /* from the runs, see collect */
    struct run_settings of_all = *settings;
    of_all.settings.shared = true;
    if (run_resolve(&run, &of_all, error)) return error->status;
    problem_means(&run.problem, FIELD_DENSITY, settings_real(&run.settings, SETTING_t_end),
                  NORM_BINS, means);
    precision->mean_density = gsl_stats_mean(means, 1, NORM_BINS);
    precision->signal = gsl_stats_absdev_m(means, 1, NORM_BINS, precision->mean_density);
    if (!(precision->signal > 1e-12 * precision->mean_density))
        precision->signal = precision->mean_density;
    return STATUS_OK;
}

/* "kernel=a eta=2" -> "a eta=2": names identify their keys. */
static void shorten(const char *label, char brief[SWEEP_LABEL])
{
    size_t used = 0;
    while (*label) {
        const size_t word = strcspn(label, " "), name = strcspn(label, "=");
        const char *value = name < word ? label + name + 1 : label;
        const bool number = strchr("0123456789.-", *value) != NULL;
        const char *from = number ? label : value;
        used += (size_t)snprintf(brief + used, SWEEP_LABEL - used, "%s%.*s", used ? " " : "",
                                 (int)(label + word - from), from);
        label += word + (label[word] == ' ');
    }
}

/* True if graded masses add a curve: for jumps between gases, unless the sweep varies the
 * grading. */
static bool want_graded(const struct run_settings *settings, const struct sweep *sweep)
{
    const struct settings *keys = &settings->settings;
    if (settings->file.dimension > 1) return false;
    for (size_t k = 0; k < sweep->key_count; k++)
        if (sweep->keys[k].key == SETTING_grade) return false;
    return !problem_foreign(keys, SETTING_grade) && settings_real(keys, SETTING_grade) == 1;
}

/* Curves besides those of the sweep and of another code. */
enum addition { GRADED, TEXTBOOK, SEED, SEED_PLAIN };
static const struct {
    enum precision_reference reference;
    const char *label, *brief;
    size_t key_count;
    const char *const *keys;
} additions[] = {
    [GRADED] = {REFERENCE_GRADED, "graded masses grade=0.5", "graded masses", KEYS(graded_keys)},
    [TEXTBOOK] = {REFERENCE_SEED, "textbook SPH", "textbook SPH", KEYS(textbook_keys)},
    [SEED] = {REFERENCE_SEED, "seed method", "seed method", KEYS(seed_keys)},
    [SEED_PLAIN] = {REFERENCE_SEED_PLAIN, "seed method, plain C", "seed method, plain C",
                    KEYS(seed_keys)},
};

/* The addition that is scheme i, after those of the sweep and of another code. */
static enum addition addition_of(const struct precision *precision, size_t i)
{
    const size_t last = precision->scheme_count - 1;
    if (precision->dim > 1) return TEXTBOOK;
    return i == last ? SEED_PLAIN : i == last - 1 ? SEED : GRADED;
}

/* Sets the scheme's keys. */
static enum status prepare(const struct precision *precision, const struct sweep *sweep, size_t i,
                           struct run_settings *settings, struct error *error)
{
    struct precision_scheme *scheme = &precision->schemes[i];
    const struct run_external *external = precision->settings->external;
    *settings = *precision->settings;
    if (external && i == sweep->count) {
        snprintf(scheme->label, sizeof scheme->label, "%s", external->title);
        snprintf(scheme->brief, sizeof scheme->brief, "%s", external->title);
        return STATUS_OK;
    }
    settings->external = NULL;
    if (i < sweep->count) {
        sweep_label(sweep, i, scheme->label);
        if (!scheme->label[0]) strcpy(scheme->label, "as given");
        shorten(scheme->label, scheme->brief);
        return sweep_apply(sweep, i, settings, error);
    }
    const enum addition added = addition_of(precision, i);
    settings->settings.shared = true;
    scheme->reference = additions[added].reference;
    strcpy(scheme->label, additions[added].label);
    strcpy(scheme->brief, additions[added].brief);
    if (added == SEED_PLAIN) settings->solver = precision_plain;
    if (settings_apply(&settings->settings, (int)additions[added].key_count,
                       (char *const *)additions[added].keys, error) ||
        (added >= SEED &&
         (settings_set(&settings->settings, SETTING_grade, "1", SOURCE_CASE, NULL, error) ||
          settings_set(&settings->settings, SETTING_mass_ratio, "1", SOURCE_CASE, NULL, error))))
        return error->status;
    return STATUS_OK;
}

/* Resolves the scheme's run with n particles; the reason of a refusal goes into
 * scheme->excluded. */
static enum status add_level(struct job *job, struct run_settings *settings, size_t n,
                             struct precision_scheme *scheme, struct error *error)
{
    char key[40], *keys[] = {key};
    struct error reason;
    snprintf(key, sizeof key, "n=%zu", n);
    if (settings_apply(&settings->settings, 1, keys, error)) return error->status;
    if (!run_resolve(&job->run, settings, &reason)) return STATUS_OK;
    snprintf(scheme->excluded, sizeof scheme->excluded, "%s", reason.message);
    if (reason.status == STATUS_CHECK_FAILED) *error = reason; /* a plug-in: no scheme */
    return reason.status == STATUS_CHECK_FAILED ? reason.status : STATUS_OK;
}

/* A scheme that failed at one n is not averaged at the others. */
static void average_all(const struct precision *precision, struct bench_subject *subjects,
                        struct job *jobs)
{
    for (size_t i = 0; i < precision->point_count; i++) {
        bool failed = subjects[i].failure.status != STATUS_OK;
        for (size_t k = 0; k < i; k++)
            failed |= jobs[k].point->scheme == jobs[i].point->scheme && subjects[k].failure.status;
        if (!failed) average(&jobs[i], precision->order, &subjects[i].failure);
    }
}

/* True if this machine failed, for want of memory, which says nothing about a scheme. Another code
 * that does not run is excluded like a scheme that breaks down. */
static bool fails_here(const struct bench_subject *subject)
{
    const struct job *job = subject->context;
    return subject->failure.status == STATUS_ENVIRONMENT && !job->run.asked.external;
}

/* Removes the points of schemes that broke down. */
static enum status collect(struct precision *precision, const struct bench_subject *subjects,
                           const struct job *jobs, struct error *error)
{
    struct precision_point *points = precision->points;
    size_t kept = 0;
    for (size_t i = 0; i < precision->point_count && precision->dim > 1; i++) {
        const struct judged *judged = &jobs[i].judged; /* of the finest sound run */
        if (subjects[i].failure.status || !judged->name) continue;
        precision->error_of = judged->name;
        precision->signal = judged->signal;
    }
    for (size_t i = 0; i < precision->point_count; i++) {
        struct precision_scheme *scheme = &precision->schemes[points[i].scheme];
        const struct error *failure = &subjects[i].failure;
        if (fails_here(&subjects[i])) return *error = *failure, error->status;
        if (scheme->excluded[0] || !failure->status) continue;
        snprintf(scheme->excluded, sizeof scheme->excluded, "n = %g: %.450s",
                 settings_real(&jobs[i].run.settings, SETTING_n), failure->message);
    }
    for (size_t i = 0; i < precision->point_count; i++) {
        struct precision_scheme *scheme = &precision->schemes[points[i].scheme];
        if (scheme->excluded[0]) continue;
        if (scheme->count++ == 0) scheme->first = kept;
        points[kept] = points[i];
        points[kept].time = subjects[i].time;
        points[kept].relative = points[kept].error / precision->signal;
        kept++;
    }
    precision->point_count = kept;
    return STATUS_OK;
}

/* The measurements: a job for each scheme and n, in the order of the points. */
struct precision_work {
    const struct precision *precision;
    const struct bench_rules *rules;
    size_t count, level_count;
    struct bench_subject *subjects;
    struct job *jobs;
    size_t *level; /* of each job, in the ladder */
    struct level {
        const struct precision_work *work;
        size_t number, pool_job;
    } levels[CASE_LADDER_MAX];
};

static void work_free(struct precision_work *work)
{
    if (!work) return;
    free(work->subjects), free(work->jobs), free(work->level);
    free(work);
}

static enum status lay_out(const struct run_settings *settings, const struct sweep *sweep,
                           const size_t *ladder, size_t count, struct precision *precision,
                           struct error *error)
{
    const size_t compared = settings->file.dimension > 1 ? 1 : 2; /* plain C is 1D only */
    const size_t schemes = sweep->count + (settings->external != NULL) + compared +
                           want_graded(settings, sweep),
                 most = schemes * count;
    *precision = (struct precision){.settings = settings, .scheme_count = schemes};
    struct precision_work *work = precision->work = calloc(1, sizeof *work);
    precision->schemes = calloc(schemes, sizeof *precision->schemes);
    precision->points = calloc(most, sizeof *precision->points);
    struct run_settings *own = malloc(sizeof *own);
    enum status status = STATUS_OK;
    if (work) {
        work->subjects = calloc(most, sizeof *work->subjects);
        work->jobs = calloc(most, sizeof *work->jobs);
        work->level = calloc(most, sizeof *work->level);
    }
    if (!precision->schemes || !precision->points || !own || !work || !work->subjects ||
        !work->jobs || !work->level)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", most);
    if (!status) status = find_scale(settings, precision, error);
    size_t n = 0, own_schemes = 0;
    struct settings left;
    for (size_t i = 0; i < schemes && !status; i++) {
        status = prepare(precision, sweep, i, own, error);
        for (size_t l = 0; l < count && !status && !precision->schemes[i].excluded[0]; l++) {
            struct job *job = &work->jobs[n];
            status = add_level(job, own, ladder[l], &precision->schemes[i], error);
            if (status || precision->schemes[i].excluded[0]) continue;
            if (own_schemes == 0 && l == 0) left = job->run.settings;
            own_schemes += l == 0 && i < sweep->count;
            if (i < sweep->count) settings_take_used(&job->run.settings, &left);
            job->point = &precision->points[n];
            precision->points[n].scheme = i;
            work->subjects[n] = (struct bench_subject){.work = execute, .context = job};
            work->level[n++] = l;
        }
    }
    precision->point_count = n;
    if (work) work->count = n, work->level_count = count, work->precision = precision;
    if (!status && !own_schemes)
        status = error_set(error, STATUS_BAD_INPUT, "bench: %s%s",
                           sweep->count > 1 ? "no combination of --vary is allowed: " : "",
                           precision->schemes[0].excluded);
    if (!status && !settings->settings.shared) status = settings_refuse_unused(&left, error);
    free(own);
    return status;
}

enum status precision_measure(const struct run_settings *settings, const struct sweep *sweep,
                              const size_t *ladder, size_t count, const struct bench_rules *rules,
                              struct precision *precision, struct error *error)
{
    enum status status = lay_out(settings, sweep, ladder, count, precision, error);
    const struct precision_work *work = precision->work;
    if (!status) status = bench_measure(work->subjects, work->count, rules, error);
    if (!status) {
        average_all(precision, work->subjects, work->jobs);
        status = collect(precision, work->subjects, work->jobs, error);
    }
    return status ? status : precision_judge(precision, error);
}

/* --- one n as a computation of a pool --------------------------------------------------------- */

/* The measurement of a job; name "" in 1D. */
static json_t *measured_json(const struct bench_subject *subject, const struct job *job)
{
    const struct precision_point *point = job->point;
    const struct bench_time *time = &subject->time;
    return result_object("status=%d message=%s n=%zu error=%g error_spread=%g? pairs=%g? wall_s=%g "
                         "cpu_s=%g spread=%g times=%zu samples=%d error_of=%s signal=%g",
                         (int)subject->failure.status, subject->failure.message, point->n,
                         point->error, point->error_spread, point->pairs, time->wall_s, time->cpu_s,
                         time->spread, (size_t)time->times, time->samples,
                         job->judged.name ? job->judged.name : "", job->judged.signal);
}

static enum status measure_level(const void *context, json_t **document, struct error *error)
{
    const struct level *level = context;
    const struct precision_work *work = level->work;
    struct bench_subject *list = calloc(work->count, sizeof *list);
    struct bench_rules rules = *work->rules;
    size_t n = 0;
    if (!list) return error_set(error, STATUS_ENVIRONMENT, "no memory for points");
    rules.progress = NULL;
    if (work->precision->settings->external) pool_end_with_parent();
    for (size_t i = 0; i < work->count; i++)
        if (work->level[i] == level->number) list[n++] = work->subjects[i];
    enum status status = bench_measure(list, n, &rules, error);
    if (!status) {
        *document = result_new("bench"); /* names this machine */
        json_t *points = json_array();
        for (size_t i = 0; i < n; i++) {
            struct job *job = list[i].context;
            if (!list[i].failure.status) average(job, work->precision->order, &list[i].failure);
            if (fails_here(&list[i])) *error = list[i].failure, status = error->status;
            json_array_append_new(points, measured_json(&list[i], job));
        }
        json_object_set_new(*document, "points", points);
    }
    free(list);
    return status;
}

/* Everything that decides the measurement at this n, as text; malloced. */
static char *level_key(const struct level *level, double *weight, struct error *error)
{
    const struct precision_work *work = level->work;
    char text[200];
    uint64_t hash = CACHE_HASH;
    *weight = 0;
    for (size_t i = 0; i < work->count; i++) {
        const struct run *run = &work->jobs[i].run;
        if (work->level[i] != level->number) continue;
        char *key = run_job_key(run, run->asked.solver ? "bench, plain" : "bench", error);
        if (!key) return NULL;
        hash = cache_hash(hash, key, strlen(key) + 1);
        free(key);
        *weight += (3 + work->rules->samples) * run_job_weight(run);
    }
    snprintf(text, sizeof text,
             "{\"kind\":\"bench\",\"level\":%zu,\"runs\":\"%016llx\","
             "\"samples\":%d,\"threads\":%d,\"time\":%.17g}",
             level->number, (unsigned long long)hash, work->rules->samples,
             work->precision->settings->threads, work->rules->least_s);
    return strdup(text);
}

enum status precision_plan(const struct run_settings *settings, const struct sweep *sweep,
                           const size_t *ladder, size_t count, const struct bench_rules *rules,
                           struct precision *precision, struct pool *pool, struct error *error)
{
    enum status status = lay_out(settings, sweep, ladder, count, precision, error);
    struct precision_work *work = precision->work;
    if (work) work->rules = rules;
    for (size_t l = 0; l < count && !status; l++) {
        struct level *level = &work->levels[l];
        char name[SWEEP_LABEL];
        double weight;
        *level = (struct level){.work = work, .number = l};
        char *key = level_key(level, &weight, error);
        snprintf(name, sizeof name, "bench %.100s, n = %zu", settings->file.name, ladder[l]);
        if (key) level->pool_job = pool_add(pool, name, key, weight, measure_level, level);
        if (!key || level->pool_job == (size_t)-1)
            status = error_set(error, STATUS_ENVIRONMENT, "no memory for points");
        free(key);
    }
    return status;
}

static void take_measured(const json_t *item, const char *processor, struct bench_subject *subject,
                          struct job *job)
{
    struct precision_point *point = job->point;
    const char *name = value_text(item, "error_of");
    subject->failure.status = (enum status)value_member(item, "status");
    snprintf(subject->failure.message, sizeof subject->failure.message, "%s",
             value_text(item, "message"));
    subject->time = (struct bench_time){.wall_s = value_member(item, "wall_s"),
                                        .cpu_s = value_member(item, "cpu_s"),
                                        .spread = value_member(item, "spread"),
                                        .times = (uint64_t)value_member(item, "times"),
                                        .samples = (int)value_member(item, "samples")};
    job->judged = (struct judged){*name ? name : NULL, (double)NAN, value_member(item, "signal")};
    point->n = (size_t)value_member(item, "n");
    point->error = value_member(item, "error");
    point->error_spread = value_member(item, "error_spread");
    point->pairs = value_member(item, "pairs");
    point->settings = job->run.settings;
    point->processor = processor;
}

enum status precision_conclude(struct precision *precision, const struct pool *pool,
                               struct error *error)
{
    const struct precision_work *work = precision->work;
    for (size_t l = 0; l < work->level_count; l++) {
        const struct pool_job *done = &pool->jobs[work->levels[l].pool_job];
        const json_t *points = json_object_get(done->document, "points");
        const char *processor = value_text(json_object_get(done->document, "machine"), "processor");
        size_t next = 0;
        if (!done->document || done->error.status) {
            *error = done->error;
            return error->status
                       ? error->status
                       : error_set(error, STATUS_ENVIRONMENT, "%s gave nothing", done->name);
        }
        for (size_t i = 0; i < work->count; i++)
            if (work->level[i] == l)
                take_measured(json_array_get(points, next++), processor, &work->subjects[i],
                              &work->jobs[i]);
    }
    if (collect(precision, work->subjects, work->jobs, error)) return error->status;
    return precision_judge(precision, error);
}

void precision_free(struct precision *precision)
{
    work_free(precision->work);
    free(precision->schemes);
    free(precision->points);
    *precision = (struct precision){0};
}
