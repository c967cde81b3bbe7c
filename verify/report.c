/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report.h"

#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "certificate.h"
#include "check.h"
#include "converge.h"
#include "league.h"
#include "result.h"
#include "run.h"
#include "suite.h"
#include "suite_output.h"
#include "verdict.h"

/* compared: the schemes below get the case's gates too, with twice its bound of the error; not
 * where one of them is known to have no order yet at these resolutions. */
static const struct {
    const char *name;
    bool compared;
} cases[] = {{"sod", true},           {"sod_standard", true},
             {"strong_shock", false}, {"two_rarefactions", true},
             {"lax", true},           {"sound_wave", true}};

/* The default scheme, and the two gradients with all else equal. */
static const struct {
    const char *label, *keys;
} schemes[] = {
    {"default", ""},
    {"standard", "kernel=cubic_spline eta=2 gradient=standard integrator=modified_leapfrog "
                 "energy=internal"},
    {"ia", "kernel=cubic_spline eta=2 gradient=ia integrator=modified_leapfrog energy=internal"},
};

enum { CASES = sizeof cases / sizeof *cases, SCHEMES = sizeof schemes / sizeof *schemes };
enum { KEYS_MAX = 16, EXACT_POINTS = 1001 };

struct task {
    enum { TASK_RUN, TASK_STUDY, TASK_CHECKS, TASK_KERNEL, TASK_LEAGUE } kind;
    const char *where; /* case or kernel */
    int scheme, dim;
    bool nightly, compared;
    double weight; /* about how long it takes, in any unit */
    json_t *document;
    struct error error;
};

/* ---- one task each ---- */

/* The case with the scheme's keys; text holds the words that arguments point to. */
static enum status prepare(const struct task *task, struct run_settings *settings,
                           struct error *error)
{
    char text[512], *arguments[KEYS_MAX], *rest = text;
    int n = 0;
    snprintf(text, sizeof text, "%s", schemes[task->scheme].keys);
    for (char *word; n < KEYS_MAX && (word = strtok_r(rest, " ", &rest));) arguments[n++] = word;
    enum status status = run_prepare(settings, task->where, n, arguments, error);
    settings->threads = 1;
    return status;
}

static void describe(const struct task *task, const char *command, const char *more,
                     json_t *document)
{
    char reproduce[1024];
    const char *keys = schemes[task->scheme].keys;
    snprintf(reproduce, sizeof reproduce, "sphproof %s %s%s%s%s", command, task->where, more,
             *keys ? " " : "", keys);
    json_object_set_new(document, "label", json_string(schemes[task->scheme].label));
    json_object_set_new(document, "reproduce", json_string(reproduce));
}

static const char *const profile_fields[] = {"density", "velocity", "pressure"};
static const enum field profile_field[] = {FIELD_DENSITY, FIELD_VELOCITY, FIELD_PRESSURE};
enum { PROFILE_FIELDS = sizeof profile_field / sizeof *profile_field };

static void append(json_t *object, const char *name, double value)
{
    json_t *array = json_object_get(object, name);
    if (!array) {
        array = json_array();
        json_object_set_new(object, name, array);
    }
    json_array_append_new(array, result_number(value));
}

/* The exact curve; points on a straight line between their neighbours are left out. */
static json_t *exact_profile(const struct run_result *result)
{
    json_t *profile = json_object();
    double lo = result->window[0], step = (result->window[1] - lo) / (EXACT_POINTS - 1);
    double kept[FIELDS], now[FIELDS], next[FIELDS];
    exact_sample(&result->exact, lo, result->time, now);
    memcpy(kept, now, sizeof kept);
    for (int i = 0; i < EXACT_POINTS; i++) {
        exact_sample(&result->exact, lo + (i + 1) * step, result->time, next);
        bool bend = i == 0 || i == EXACT_POINTS - 1;
        for (int f = 0; f < FIELDS; f++)
            bend = bend ||
                   !(fabs(next[f] - 2 * now[f] + kept[f]) <= 1e-9 * (fabs(now[f]) + fabs(next[f])));
        if (bend) {
            append(profile, "x", lo + i * step);
            for (int f = 0; f < PROFILE_FIELDS; f++)
                append(profile, profile_fields[f], now[profile_field[f]]);
        }
        memcpy(kept, now, sizeof kept);
        memcpy(now, next, sizeof now);
    }
    return profile;
}

static json_t *profile(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    json_t *particles = json_object();
    for (size_t i = 0; i < s->n; i++) {
        const double x = s->x[0][i];
        if (!(x >= result->window[0] && x <= result->window[1])) continue;
        const double value[PROFILE_FIELDS] = {s->rho[i], s->v[0][i], s->P[i]};
        double exact[FIELDS];
        exact_sample(&result->exact, x, result->time, exact);
        append(particles, "x", x);
        for (int f = 0; f < PROFILE_FIELDS; f++) {
            char name[64];
            snprintf(name, sizeof name, "exact_%s", profile_fields[f]);
            append(particles, profile_fields[f], value[f]);
            append(particles, name, exact[profile_field[f]]);
        }
    }
    json_object_set_new(particles, "exact", exact_profile(result));
    return particles;
}

static enum status compute_run(struct task *task)
{
    struct run_settings settings;
    struct run_result result;
    if (prepare(task, &settings, &task->error)) return task->error.status;
    enum status status = run_execute(&settings, &result, &task->error);
    if (status != STATUS_OK && status != STATUS_BROKE_DOWN) return status;
    task->document = result_new("run");
    run_add_json(&settings, &result, task->document);
    describe(task, "run", "", task->document);
    if (status == STATUS_OK) json_object_set_new(task->document, "profile", profile(&result));
    run_free(&result);
    return STATUS_OK;
}

static enum status compute_study(struct task *task)
{
    struct run_settings settings;
    if (prepare(task, &settings, &task->error)) return task->error.status;
    if (task->scheme && !task->compared) settings.file.gate_count = 0;
    for (size_t i = 0; i < settings.file.gate_count && task->scheme; i++)
        settings.file.gates[i].gate.bound *= 3;
    size_t *ladder = settings.file.ladder, count = settings.file.ladder_count;
    char more[256] = "";
    if (task->nightly && count && count < CASE_LADDER_MAX) { /* one level more */
        ladder[count] = 2 * ladder[count - 1];
        count++;
        int used = snprintf(more, sizeof more, " --n ");
        for (size_t i = 0; i < count && used < (int)sizeof more; i++)
            used +=
                snprintf(more + used, sizeof more - (size_t)used, "%s%zu", i ? "," : "", ladder[i]);
    }
    struct converge_result *result = calloc(1, sizeof *result);
    if (!result) return error_set(&task->error, STATUS_ENVIRONMENT, "no memory for a study");
    enum status status =
        converge_execute(&settings, ladder, count, result, NULL, NULL, &task->error);
    if (status == STATUS_OK || status == STATUS_BROKE_DOWN) {
        task->document = result_new("converge");
        json_object_set_new(task->document, "case", json_string(settings.file.name));
        json_object_set_new(task->document, "title", json_string(settings.file.title));
        json_object_set_new(task->document, "status",
                            json_string(status           ? "broke_down"
                                        : result->passed ? "pass"
                                                         : "fail"));
        if (status)
            json_object_set_new(task->document, "message", json_string(task->error.message));
        converge_add_json(result, NULL, task->document);
        describe(task, "converge", more, task->document);
        status = STATUS_OK;
    }
    free(result);
    return status;
}

static enum status compute_checks(struct task *task)
{
    struct suite suite;
    const struct suite_choice choice = {.slow = task->nightly, .mutants = true};
    enum status status =
        suite_run(&suite, check_registry, check_registry_count, &choice, &task->error);
    if (status != STATUS_OK && status != STATUS_CHECK_FAILED) return status;
    task->document = result_new("verify");
    suite_output_json(&suite, task->document);
    suite_free(&suite);
    return STATUS_OK;
}

static enum status compute_kernel(struct task *task)
{
    struct kernel kernel;
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (!certificate) return error_set(&task->error, STATUS_ENVIRONMENT, "no memory for a kernel");
    enum status status = kernel_select(&kernel, task->where, 5, &task->error);
    if (!status) status = certificate_measure(certificate, &kernel, task->dim, &task->error);
    if (!status) {
        char reproduce[128];
        snprintf(reproduce, sizeof reproduce, "sphproof kernel %s --dim %d", task->where,
                 task->dim);
        task->document = result_new("kernel");
        json_object_set_new(task->document, "kernel", json_string(task->where));
        json_object_set_new(task->document, "dim", json_integer(task->dim));
        json_object_set_new(task->document, "h", result_number(1));
        json_object_set_new(task->document, "values", json_array());
        certificate_json(certificate, 1, task->document);
        json_object_set_new(task->document, "reproduce", json_string(reproduce));
        certificate_free(certificate);
    }
    free(certificate);
    return status;
}

static enum status compute_league(struct task *task)
{
    struct league_row rows[LEAGUE_ROWS_MAX];
    size_t count;
    const enum status status = league_measure(rows, &count, &task->error);
    if (!status) task->document = league_json(rows, count);
    return status;
}

static enum status compute(struct task *task)
{
    switch (task->kind) {
    case TASK_RUN:
        return compute_run(task);
    case TASK_STUDY:
        return compute_study(task);
    case TASK_CHECKS:
        return compute_checks(task);
    case TASK_KERNEL:
        return compute_kernel(task);
    case TASK_LEAGUE:
        return compute_league(task);
    }
    return STATUS_OK;
}

/* ---- all of them ---- */

/* Longest first, so that side by side they end together; the results keep the order of the list. */
static size_t list_tasks(struct task *tasks, bool nightly)
{
    size_t n = 0;
    if (tasks) tasks[n] = (struct task){.kind = TASK_CHECKS, .where = "checks", .weight = 20};
    n++;
    if (tasks) tasks[n] = (struct task){.kind = TASK_LEAGUE, .where = "operators", .weight = 2};
    n++;
    for (int c = 0; c < CASES; c++) {
        for (int s = 0; s < SCHEMES; s++) {
            if (tasks)
                tasks[n] = (struct task){.kind = TASK_STUDY,
                                         .where = cases[c].name,
                                         .scheme = s,
                                         .compared = cases[c].compared,
                                         .weight = 1};
            n++;
        }
    }
    for (int c = 0; c < CASES; c++) {
        for (int s = 0; s < SCHEMES; s++) {
            if (tasks)
                tasks[n] = (struct task){
                    .kind = TASK_RUN, .where = cases[c].name, .scheme = s, .weight = 0.1};
            n++;
        }
    }
    for (size_t k = 0; k < kernel_family.n; k++) {
        for (int dim = 1; dim <= 3; dim++) {
            if (tasks)
                tasks[n] = (struct task){.kind = TASK_KERNEL,
                                         .where = kernel_family.members[k]->name,
                                         .dim = dim,
                                         .weight = 0.3};
            n++;
        }
    }
    for (size_t k = 0; tasks && k < n; k++) tasks[k].nightly = nightly;
    return n;
}

static void run_tasks(struct task *tasks, size_t n, const struct report_settings *settings)
{
    double done = 0, total = 0;
    for (size_t k = 0; k < n; k++) total += tasks[k].weight;
#pragma omp parallel for schedule(dynamic, 1) num_threads(settings->jobs) if (settings->jobs > 1)
    for (size_t k = 0; k < n; k++) {
        tasks[k].error.status = compute(&tasks[k]);
#pragma omp critical(report_progress)
        {
            done += tasks[k].weight;
            if (settings->progress)
                settings->progress(settings->context, tasks[k].where, done, total);
        }
    }
}

static json_t *collect(struct task *tasks, size_t n, enum report_mode mode, double seconds)
{
    json_t *results = result_new("report"), *runs = json_array(), *studies = json_array(),
           *kernels = json_array();
    json_object_set_new(results, "mode", json_string(mode == REPORT_QUICK ? "quick" : "nightly"));
    json_object_set_new(results, "seconds", result_number(seconds));
    for (size_t k = 0; k < n; k++) {
        json_t *document = tasks[k].document;
        switch (tasks[k].kind) {
        case TASK_RUN:
            json_array_append(runs, document);
            break;
        case TASK_STUDY:
            json_array_append(studies, document);
            break;
        case TASK_KERNEL:
            json_array_append(kernels, document);
            break;
        case TASK_CHECKS:
            json_object_set(results, "verify", document);
            break;
        case TASK_LEAGUE:
            json_object_set(results, "gradients", document);
            break;
        }
    }
    json_object_set_new(results, "runs", runs);
    json_object_set_new(results, "studies", studies);
    json_object_set_new(results, "kernels", kernels);
    json_object_set_new(results, "verdict", verdict_make(results));
    return results;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

enum status report_compute(const struct report_settings *settings, json_t **results,
                           struct error *error)
{
    *results = NULL;
    const double began = now();
    size_t n = list_tasks(NULL, false);
    struct task *tasks = calloc(n, sizeof *tasks);
    if (!tasks) return error_set(error, STATUS_ENVIRONMENT, "no memory for a report");
    list_tasks(tasks, settings->mode == REPORT_NIGHTLY);
    gsl_set_error_handler_off();
    json_object_seed(0); /* before threads do it at once */
    run_tasks(tasks, n, settings);
    enum status status = STATUS_OK;
    for (size_t k = 0; k < n && !status; k++)
        if (tasks[k].error.status)
            status = error_set(error, tasks[k].error.status, "%s", tasks[k].error.message);
    if (!status) *results = collect(tasks, n, settings->mode, now() - began);
    for (size_t k = 0; k < n; k++) json_decref(tasks[k].document);
    free(tasks);
    return status;
}
