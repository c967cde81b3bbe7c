/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "report_piece.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "autopsy.h"
#include "bench_skips.h"
#include "certificate.h"
#include "check_registry.h"
#include "league.h"
#include "precision.h"
#include "problem_list.h"
#include "result.h"
#include "run_job.h"
#include "run_output.h"
#include "suite.h"
#include "suite_output.h"
#include "value.h"

static enum status compute_run(const struct report_piece *piece, json_t **document,
                               struct error *error)
{
    struct run_result result;
    struct run run = piece->run;
    struct trace trace = {0};
    if (run.asked.external) return run_job_external(&run, true, document, error);
    run.asked.trace = &trace;
    const enum status status = run_execute(&run, &result, error);
    if (status != STATUS_OK && status != STATUS_BROKE_DOWN) return status;
    *document = result_new("run");
    run_add_json(&piece->settings, &result, *document);
    if (status == STATUS_OK) json_object_set_new(*document, "profile", profile_json(&result));
    json_object_set_new(*document, "through_time", trace_json(&trace, run.asked.file.dimension));
    run_free(&result);
    return status;
}

static enum status compute_checks(const struct report_piece *piece, json_t **document,
                                  struct error *error)
{
    struct suite suite;
    const struct suite_choice choice = {
        .groups = &piece->where, .group_count = 1, .slow = piece->slow, .mutants = true};
    const enum status status =
        suite_run(&suite, check_registry, check_registry_count, &choice, error);
    if (status == STATUS_ENVIRONMENT) return status;
    *document = result_new("verify");
    suite_output_json(&suite, *document);
    suite_free(&suite);
    return STATUS_OK; /* also if checks failed: the document says so */
}

static enum status compute_kernel(const struct report_piece *piece, json_t **document,
                                  struct error *error)
{
    struct kernel kernel;
    struct certificate *certificate = calloc(1, sizeof *certificate);
    if (!certificate) return error_set(error, STATUS_ENVIRONMENT, "no memory for a kernel");
    enum status status = kernel_select(&kernel, piece->where, 5, error);
    if (!status) status = certificate_measure(certificate, &kernel, piece->dim, NULL, error);
    if (!status) {
        char reproduce[128];
        snprintf(reproduce, sizeof reproduce, "sphproof kernel %s --dim %d", piece->where,
                 piece->dim);
        *document = result_new("kernel");
        result_add(*document, "kernel=%s dim=%d h=%g values=%p", piece->where, piece->dim, 1.0,
                   (void *)json_array());
        certificate_json(certificate, 1, *document);
        result_add(*document, "reproduce=%s", reproduce);
        certificate_free(certificate);
    }
    free(certificate);
    return status;
}

static enum status compute_league(const struct report_piece *piece, json_t **document,
                                  struct error *error)
{
    (void)piece;
    struct league_row *rows;
    size_t count;
    const enum status status = league_measure(&rows, &count, error);
    if (status) return status;
    *document = league_json(rows, count);
    free(rows);
    return status;
}

/* Schemes that answer the first two questions: which kernel is best, and which gradient at shocks
 * or which viscosity in smooth flow; in 2D and 3D also the benefit of shifting. */
static const char *vary(const struct settings *settings)
{
    if (settings->dim > 1)
        return "kernel=cubic_spline,wendland_c2,wendland_c4,gradient,shifting=none,closed";
    return problem_of(settings)->smooth
               ? "kernel=quadratic_spline,cubic_spline,viscosity=none,constant,reconstructed,fading"
               : "kernel=quadratic_spline,cubic_spline,quartic_spline,gradient";
}

static enum status compute_bench(const struct report_piece *piece, json_t **document,
                                 struct error *error)
{
    const struct bench_rules *rules = &piece->rules;
    const struct case_file *file = &piece->settings.file;
    const char *varied = vary(&piece->settings.settings);
    struct precision precision = {0};
    struct sweep *sweep = calloc(1, sizeof *sweep);
    if (!sweep) return error_set(error, STATUS_ENVIRONMENT, "no memory for a bench");
    enum status status = sweep_parse(sweep, varied, error);
    if (!status)
        status = precision_measure(&piece->settings, sweep, file->ladder, file->ladder_count, rules,
                                   &precision, error);
    if (!status) {
        char reproduce[256];
        snprintf(reproduce, sizeof reproduce, "sphproof bench %s --vary %s --time %g --samples %d",
                 piece->where, varied, rules->least_s, rules->samples);
        *document = result_new("bench");
        precision_add_json(&precision, *document);
        result_add(*document, "reproduce=%s", reproduce);
    }
    precision_free(&precision);
    free(sweep);
    return status;
}

static enum status compute_skips(const struct report_piece *piece, json_t **document,
                                 struct error *error)
{
    struct bench_skips skips;
    const enum status status =
        bench_skips_measure(&piece->settings, 1, &piece->rules, BENCH_SLEEP, &skips, error);
    if (!status) {
        char reproduce[256];
        snprintf(reproduce, sizeof reproduce, "sphproof bench %s %s --skips --samples %d",
                 piece->where, piece->keys, piece->rules.samples);
        *document = result_new("bench");
        json_object_set_new(*document, "points", json_array());
        bench_skips_add_json(&skips, true, *document);
        result_add(*document, "reproduce=%s", reproduce);
    }
    bench_skips_free(&skips);
    return status;
}

static enum status compute_autopsy(const struct report_piece *piece, json_t **document,
                                   struct error *error)
{
    const struct run_settings *settings = &piece->settings;
    size_t ladder[CASE_LADDER_MAX], count;
    struct autopsy autopsy;
    struct run last;
    char reproduce[256];
    if (sweep_ladder(piece->sizes, ORDER_LEVELS_MIN, settings->file.dimension, ladder, &count,
                     error) ||
        autopsy_ladder(settings, ladder, count, &autopsy, &last, error))
        return error->status;
    snprintf(reproduce, sizeof reproduce, "sphproof autopsy %s%s%s --n %s", piece->where,
             *piece->keys ? " " : "", piece->keys, piece->sizes);
    *document = result_new("autopsy");
    autopsy_add_case(&last, &autopsy, *document);
    result_add(*document, "reproduce=%s", reproduce);
    return STATUS_OK;
}

static const struct {
    const char *name;
    double weight; /* estimated seconds; runs and checks have their own */
    enum status (*compute)(const struct report_piece *, json_t **, struct error *);
} kinds[] = {
    [REPORT_RUN] = {"profile", 0, compute_run},
    [REPORT_CHECKS] = {"checks", 0, compute_checks},
    [REPORT_KERNEL] = {"kernel", 0.1, compute_kernel},
    [REPORT_LEAGUE] = {"league", 2, compute_league},
    [REPORT_BENCH] = {"work-precision", 5, compute_bench},
    [REPORT_SKIPS] = {"skips", 3, compute_skips},
    [REPORT_AUTOPSY] = {"autopsy", 4, compute_autopsy},
};

static enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct report_piece *piece = context;
    return kinds[piece->kind].compute(piece, document, error);
}

/* Estimated seconds of a piece that is not a run. */
static double weight_of(const struct report_piece *piece)
{
    const struct suite_choice choice = {
        .groups = &piece->where, .group_count = 1, .slow = piece->slow};
    double weight = kinds[piece->kind].weight;
    for (size_t i = 0; piece->kind == REPORT_CHECKS && i < check_registry_count; i++)
        if (suite_chosen(check_registry[i], &choice)) weight += suite_cost(check_registry[i]);
    return weight;
}

enum status report_piece_add(struct pool *pool, struct report_piece *piece, struct error *error)
{
    char name[128], *run = NULL, *key = name;
    snprintf(name, sizeof name, "%s of %s%s%s%s%s", kinds[piece->kind].name, piece->where,
             *piece->keys ? " " : "", piece->keys, piece->sizes ? " " : "",
             piece->sizes ? piece->sizes : "");
    if (piece->kind == REPORT_CHECKS && piece->slow) strcat(name, ", slow ones too");
    if (piece->kind == REPORT_KERNEL)
        snprintf(name, sizeof name, "kernel %s, dim %d", piece->where, piece->dim);
    if (piece->kind == REPORT_RUN &&
        (run_resolve(&piece->run, &piece->settings, error) ||
         !(key = run = run_job_key(&piece->run, RUN_JOB_PROFILE, error))))
        return error->status;
    const double weight = run ? run_job_weight(&piece->run) : weight_of(piece);
    piece->job = pool_add(pool, name, key, weight, compute, piece);
    free(run);
    if (piece->job == (size_t)-1)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a piece of the report");
    pool->jobs[piece->job].fickle = piece->run.asked.external != NULL;
    return STATUS_OK;
}

/* ---- joining checks ---- */

/* Counts each mutant once; it is detected if every entry that has it detected it. */
static void count_mutants(const json_t *list, json_t *summary)
{
    json_t *all = json_object(); /* whether each was detected, by name */
    const json_t *entry, *detected;
    const char *name;
    size_t i;
    int count = 0;
    json_array_foreach(list, i, entry) {
        name = value_text(entry, "mutant");
        detected = json_object_get(entry, "detected");
        if (!json_is_false(json_object_get(all, name)))
            json_object_set_new(all, name, json_boolean(json_is_true(detected)));
    }
    json_object_foreach(all, name, detected) count += json_is_true(detected);
    result_add(summary, "mutants=%zu detected=%d", json_object_size(all), count);
    json_decref(all);
}

void report_piece_join(json_t *verify, json_t *part)
{
    static const char *const lists[] = {"checks", "mutants"};
    static const char *const counts[] = {"passed", "failed", "skipped"};
    json_t *summary = json_object_get(verify, "summary");
    if (!summary) json_object_set_new(verify, "summary", summary = json_object());
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        json_t *list = json_object_get(verify, lists[i]);
        if (!list) json_object_set_new(verify, lists[i], list = json_array());
        json_array_extend(list, json_object_get(part, lists[i]));
    }
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        const json_t *more = json_object_get(json_object_get(part, "summary"), counts[i]);
        const json_int_t sum = json_integer_value(json_object_get(summary, counts[i]));
        json_object_set_new(summary, counts[i], json_integer(sum + json_integer_value(more)));
    }
    count_mutants(json_object_get(verify, "mutants"), summary);
}
