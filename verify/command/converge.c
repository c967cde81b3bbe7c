/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof converge: a ladder of resolutions, orders with their uncertainty, gates. */
#include "converge.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "progress.h"
#include "result.h"
#include "sweep.h"
#include "table.h"

static void show_progress(void *context, double done, double total)
{
    progress_update(context, done, total);
}

static void print_ladder(const struct case_file *file, const struct converge_result *result,
                         const struct table_style *style)
{
    printf("%s%10s %12s", style->bold, "n", "h");
    for (int field = 0; field < FIELDS; field++)
        if (file->fields[field]) printf(" %15s", field_family.members[field]->name);
    printf(" %10s%s\n", "CPU s", style->end);
    for (size_t i = 0; i < result->level_count; i++) {
        const struct converge_level *level = &result->levels[i];
        printf("%10zu %12.4e", level->n, level->h);
        for (int field = 0; field < FIELDS; field++)
            if (file->fields[field]) printf(" %15.4e", level->errors[field][NORM_L1]);
        printf(" %10.3g\n", level->cpu_s);
    }
}

static void print_orders(const struct case_file *file, const struct converge_result *result,
                         const struct table_style *style)
{
    printf("%s%-22s %7s %18s  %-14s %s%s\n", style->bold, "order of", "order", "95 % interval",
           "class", "between levels", style->end);
    for (int field = 0; field < FIELDS; field++)
        for (int norm = 0; norm < NORMS; norm++) {
            const struct converge_order *order = &result->orders[field][norm];
            if (order->status == GATE_NONE && (norm != NORM_L1 || !file->fields[field])) continue;
            char name[40];
            snprintf(name, sizeof name, "%s_%s", field_family.members[field]->name,
                     norm_family.members[norm]->name);
            printf("%-22s %7.3f   [%6.3f, %6.3f]  %-14s", name, order->fit.order, order->fit.low,
                   order->fit.high, order_class_name(order->fit.class));
            for (size_t i = 0; i + 1 < order->fit.n; i++) printf(" %.2f", order->fit.pairwise[i]);
            printf("\n");
            if (order->status == GATE_NONE) continue;
            const bool good = order->status == GATE_PASS;
            printf("    gate: order in [%g, %g], error at n = %zu at most %.3g: %s%s%s%s%s\n",
                   order->gate.low, order->gate.high, result->levels[result->level_count - 1].n,
                   order->gate.bound, good ? style->good : style->bad, good ? "pass" : "FAIL",
                   style->end, good ? "" : ": ", order->why);
        }
}

static void print_floor(const struct converge_result *result, const struct table_style *style)
{
    printf("lattice sums of %s at eta = %g: density %+.1e, gradient %+.1e (relative): %s\n",
           result->scheme.kernel.member.name, result->scheme.eta, result->floor_density,
           result->floor_gradient,
           fmax(fabs(result->floor_density), fabs(result->floor_gradient)) < 1e-10
               ? "a partition of unity"
               : "a floor under every error");
    if (!result->floor_explains) return;
    printf("%sthe lost order is that floor's: the error at the finest level is of its size.%s",
           style->bad, style->end);
    if (result->scheme.kernel.unity_width > 0)
        printf(" Exact sums: eta = %g, %g ...", result->scheme.kernel.unity_width,
               2 * result->scheme.kernel.unity_width);
    printf("\n");
}

static void print_functionals(const struct converge_result *result, const struct table_style *style)
{
    printf("%s%-22s %14s %14s %10s  %s%s\n", style->bold, "functional", "finest", "extrapolated",
           "GCI", "order, class", style->end);
    for (size_t i = 0; i < result->functional_count; i++) {
        const struct converge_level *finest = &result->levels[result->level_count - 1];
        const struct order_extrapolation *e = &result->functionals[i];
        printf("%-22s %14.8g", finest->functionals[i].name, finest->functionals[i].value);
        if (isfinite(e->value))
            printf(" %14.8g %9.2g%%  %.2f, ", e->value, 100 * e->gci_fine, e->order);
        else
            printf(" %14s %10s  ", "-", "-");
        printf("%s\n", order_class_name(e->class));
    }
}

static void print_study(const struct case_file *file, const struct converge_result *result,
                        const char *label, const struct options *options)
{
    const struct table_style style = table_style(options);
    printf("%s%s%s: %s%s%s\n", style.bold, file->name, style.end, file->title, *label ? ", " : "",
           label);
    print_ladder(file, result, &style);
    printf("%serrors: L1 = sum V|q - exact|/sum V over the measure window, code units; h: mean "
           "there%s\n",
           style.faint, style.end);
    print_orders(file, result, &style);
    printf("%sorder: least squares of log(error) against log(box/n), Student t%s\n", style.faint,
           style.end);
    print_floor(result, &style);
    print_functionals(result, &style);
    if (result->suspicion[0])
        printf("%ssuspicious: %s%s\n", style.bad, result->suspicion, style.end);
    printf("\n");
}

/* One level's L1 of all fields at the finest resolution, to notice a setting without effect. */
static bool same_as_before(const struct converge_result *a, const struct converge_result *b)
{
    const size_t last = a->level_count - 1;
    return a->level_count == b->level_count &&
           memcmp(a->levels[last].errors, b->levels[last].errors, sizeof a->levels[last].errors) ==
               0;
}

struct study {
    const struct options *options;
    struct run_settings settings;
    struct sweep sweep;
    size_t ladder[CASE_LADDER_MAX], count;
    json_t *document;
    bool passed;
    size_t excluded;
};

/* A combination that the scheme excludes is no error of the sweep; it is listed with the reason. */
static void exclude(struct study *study, size_t i, const char *label, const char *why)
{
    json_t *list = json_object_get(study->document, "excluded");
    json_array_append_new(
        list, json_pack("{s:o, s:s}", "settings", sweep_json(&study->sweep, i), "reason", why));
    if (study->options->speak) printf("%s: excluded: %s\n\n", label, why);
    study->excluded++;
}

static enum status run_combination(struct study *study, size_t i, struct converge_result *result,
                                   struct error *error)
{
    struct run_settings settings = study->settings;
    struct settings resolved;
    struct scheme scheme;
    struct progress progress;
    struct error reason = {0};
    char label[SWEEP_LABEL], what[SWEEP_LABEL + 80];
    const struct sweep *sweep = &study->sweep;
    sweep_label(sweep, i, label);
    if (sweep_apply(sweep, i, &settings, error)) return error->status;
    resolved = settings.settings;
    if (sweep->count > 1 &&
        settings_resolve(&resolved, settings.file.dimension, &scheme, &reason)) {
        exclude(study, i, label, reason.message);
        return STATUS_OK;
    }
    snprintf(what, sizeof what, "%s %s", settings.file.name, label);
    progress_begin(&progress, what, study->options);
    const enum status status = converge_execute(&settings, study->ladder, study->count, result,
                                                show_progress, &progress, error);
    progress_end(&progress);
    if (status && status != STATUS_BROKE_DOWN) return status;
    json_t *varied = sweep_json(sweep, i);
    converge_add_json(result, sweep->key_count ? varied : NULL, study->document);
    json_decref(varied);
    if (status) {
        json_object_set_new(study->document, "status", json_string("broke_down"));
        json_object_set_new(study->document, "message", json_string(error->message));
        return status;
    }
    study->passed = study->passed && result->passed;
    if (study->options->speak) print_study(&settings.file, result, label, study->options);
    return STATUS_OK;
}

static enum status run_all(struct study *study, struct error *error)
{
    enum status status = STATUS_OK;
    struct converge_result *results = calloc(2, sizeof *results);
    if (!results) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t i = 0; i < study->sweep.count && !status; i++) {
        struct converge_result *now = &results[i % 2], *before = &results[(i + 1) % 2];
        now->level_count = 0;
        status = run_combination(study, i, now, error);
        if (!status && now->level_count && before->level_count && same_as_before(now, before)) {
            char label[SWEEP_LABEL];
            sweep_label(&study->sweep, i, label);
            json_object_set_new(study->document, "suspicion",
                                json_sprintf("%s gives the same errors as the one before", label));
            if (!study->options->quiet)
                fprintf(stderr, "sphproof: note: %s gives the same errors as the one before\n",
                        label);
        }
    }
    free(results);
    if (!status && study->excluded == study->sweep.count)
        status =
            error_set(error, STATUS_BAD_INPUT, "converge: no combination of --vary is allowed");
    return status;
}

static enum status take_ladder(struct study *study, struct error *error)
{
    const char *text = options_value(study->options, "n");
    const struct case_file *file = &study->settings.file;
    if (text) return sweep_ladder(text, ORDER_LEVELS_MIN, study->ladder, &study->count, error);
    if (file->ladder_count == 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "converge: the case %s has no ladder; give one: --n 100,200,400,800",
                         file->name);
    memcpy(study->ladder, file->ladder, sizeof study->ladder);
    study->count = file->ladder_count;
    return STATUS_OK;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct study study = {.options = options, .passed = true};
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    if (run_prepare(&study.settings, arguments[0], n - 1, arguments + 1, error) ||
        sweep_parse(&study.sweep, options_value(options, "vary"), error) ||
        take_ladder(&study, error))
        return error->status;
    if (study.settings.settings.value[SETTING_n].source == SOURCE_USER)
        return error_set(error, STATUS_BAD_INPUT,
                         "converge: the key n and a ladder exclude each other; allowed: --n "
                         "N1,N2,N3,N4,...");
    study.settings.threads = options->threads;
    study.document = result_new("converge");
    json_object_set_new(study.document, "case", json_string(study.settings.file.name));
    json_object_set_new(study.document, "status", json_string("ok"));
    json_object_set_new(study.document, "excluded", json_array());
    struct settings resolved = study.settings.settings;
    struct scheme scheme;
    struct error ignored;
    if (!settings_resolve(&resolved, study.settings.file.dimension, &scheme, &ignored))
        json_object_set_new(study.document, "settings", settings_json(&resolved));
    enum status status = run_all(&study, error);
    struct error trouble = {0};
    if (options->json && (status == STATUS_OK || status == STATUS_BROKE_DOWN) &&
        result_write(study.document, options->json, &trouble)) {
        *error = trouble;
        status = trouble.status;
    }
    json_decref(study.document);
    return status == STATUS_OK && !study.passed ? STATUS_CHECK_FAILED : status;
}

static const struct command_option own_options[] = {
    {"n", "N1,N2,...", "numbers of particles, at least four distinct ones (default: the case's)"},
    {"vary", "KEY[=A,B][,...]", "repeat for every member of a family, or for these values"},
    {NULL, NULL, NULL},
};

const struct command command_converge = {
    .name = "converge",
    .synopsis = "CASE [KEY=VALUE ...]",
    .help = "a ladder of resolutions: orders with 95 % intervals, and the case's gates\n"
            "A gate passes if the order lies inside it, half of the interval is at most 0.15, and "
            "the\nerror at the finest level is below its bound. Exit status 1: a gate failed.",
    .run = run,
    .options = own_options,
    .examples = "sphproof converge sod\n"
                "sphproof converge sod --n 100,200,400,800 kernel=cubic_spline eta=2\n"
                "sphproof converge sod --vary kernel=cubic_spline,wendland_c2,gradient\n"
                "sphproof converge sound_wave --json orders.json",
};
