/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof converge: a ladder of resolutions, orders with their uncertainty, gates. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "code_run.h"
#include "command.h"
#include "result.h"
#include "run_output.h"
#include "sharing.h"
#include "study.h"
#include "table.h"

/* True if this field of the case has an exact solution. */
static bool measured(const struct case_file *file, const struct study_result *result, int field)
{
    bool found = false;
    for (size_t i = 0; i < result->level_count; i++)
        found = found || isfinite(result->levels[i].errors[field][NORM_L1]);
    return file->fields[field] && found;
}

static void print_ladder(const struct study *study, const struct study_result *result,
                         const struct table_style *style)
{
    const struct case_file *file = &study->settings.file;
    printf("%s%10s %12s", style->bold, "n", "h");
    for (int field = 0; field < FIELDS; field++)
        if (measured(file, result, field)) printf(" %17s", field_family.members[field]->name);
    printf(" %10s%s\n", "CPU s", style->end);
    for (size_t i = 0; i < result->level_count; i++) {
        const struct study_level *level = &result->levels[i];
        printf("%10zu %12.4e", level->n, level->h);
        for (int field = 0; field < FIELDS; field++)
            if (!measured(file, result, field))
                continue;
            else if (study->replicates > 1)
                printf(" %11.4e +-%2.0f%%", level->errors[field][NORM_L1],
                       100 * level->spread[field][NORM_L1]);
            else
                printf(" %17.4e", level->errors[field][NORM_L1]);
        printf(" %10.3g\n", level->cpu_s);
    }
}

/* A gate on the error alone accepts any order. */
static void print_gate(const struct study_result *result, const struct study_order *order,
                       const struct table_style *style)
{
    const bool good = order->status == FINDING_PASS, known = order->status == FINDING_KNOWN;
    if (order->status == FINDING_NONE) return;
    printf("    gate: ");
    if (isfinite(order->gate.low)) printf("order in [%g, %g], ", order->gate.low, order->gate.high);
    printf("error at n = %zu ", result->levels[result->level_count - 1].n);
    if (order->least > 0) printf("at least %.3g, ", order->least);
    const char *color = good                             ? style->good
                        : order->status >= FINDING_SMOKE ? style->faint
                                                         : style->bad;
    printf("at most %.3g: %s%s%s%s%s\n", order->gate.bound, color, finding_words[order->status],
           style->end, good ? "" : ": ", order->why);
    if (known) printf("    known: %s\n", order->known);
}

static void print_orders(const struct case_file *file, const struct study_result *result,
                         const struct table_style *style)
{
    printf("%s%-22s %7s %18s  %-14s %s%s\n", style->bold, "order of", "order", "95 % interval",
           "class", "between levels", style->end);
    for (int field = 0; field < FIELDS; field++)
        for (int norm = 0; norm < NORMS; norm++) {
            const struct study_order *order = &result->orders[field][norm];
            if (order->status == FINDING_NONE &&
                (norm != NORM_L1 || !measured(file, result, field)))
                continue;
            char name[40];
            snprintf(name, sizeof name, "%s_%s", field_family.members[field]->name,
                     field_norm_family.members[norm]->name);
            printf("%-22s %7.3f   [%6.3f, %6.3f]  %-14s", name, order->fit.order, order->fit.low,
                   order->fit.high, order_class_name(order->fit.class));
            for (size_t i = 0; i + 1 < order->fit.n; i++) printf(" %.2f", order->fit.pairwise[i]);
            printf("\n");
            print_gate(result, order, style);
        }
}

static void print_floor(const struct study_result *result, const struct table_style *style)
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

static void print_functionals(const struct study_result *result, const struct table_style *style)
{
    printf("%s%-22s %14s %14s %10s %14s  %s%s\n", style->bold, "functional", "finest",
           "extrapolated", "GCI", "exact", "order, class", style->end);
    for (size_t i = 0; i < result->functional_count; i++) {
        const struct study_level *finest = &result->levels[result->level_count - 1];
        const struct order_extrapolation *e = &result->functionals[i];
        printf("%-22s %14.8g", result->functional_names[i], finest->functionals[i]);
        if (isfinite(e->value))
            printf(" %14.8g %9.2g%%", e->value, 100 * e->gci_fine);
        else
            printf(" %14s %10s", "-", "-");
        printf(" %14.8g  ", result->functional_exact[i]);
        if (isfinite(e->order)) printf("%.2f, ", e->order);
        printf("%s\n", order_class_name(e->class));
        print_gate(result, &result->functional_errors[i], style);
    }
}

/* Prints conserved quantities that have a gate. */
static void print_kept(const struct study_result *result, const struct table_style *style)
{
    for (size_t k = 0; k < TRACE_FIGURES; k++) {
        if (result->kept[k].status == FINDING_NONE) continue;
        printf("%-22s %14.8g at the finest level\n", trace_figures[k], result->kept[k].fit.finest);
        print_gate(result, &result->kept[k], style);
    }
}

static void print_budget(const struct study_result *result, const struct table_style *style)
{
    const struct study_level *finest = &result->levels[result->level_count - 1];
    const struct regions *regions = finest->budget.regions;
    if (!regions) return;
    double whole = 0;
    for (size_t r = 0; regions->names[r]; r++) whole += finest->budget.l1[r][FIELD_DENSITY];
    printf("%s%-22s %12s %7s  %s%s\n", style->bold, "L1 of density from", "finest", "share",
           "order, 95 % interval", style->end);
    for (size_t r = 0; regions->names[r]; r++) {
        const double part = finest->budget.l1[r][FIELD_DENSITY];
        const struct order_fit *fit = &result->regions[r];
        if (part == 0) continue;
        printf("%-22s %12.4e %6.1f%%", regions->names[r], part, 100 * part / whole);
        if (fit->n) printf("  %.3f [%6.3f, %6.3f]", fit->order, fit->low, fit->high);
        printf("\n");
    }
    if (isnan(result->still)) return;
    const bool good = result->still_status != FINDING_FAIL;
    printf("still gas stays still: |v - v0| <= %.2g c far ahead of every wave (allowed: %g): "
           "%s%s%s\n",
           result->still, STUDY_STILL_BOUND, good ? style->good : style->bad,
           result->still_status == FINDING_NONE
               ? "not judged: the start is random, or another code computes"
           : good ? "pass"
                  : "FAIL",
           style->end);
}

static void print_errors(const struct study *study, const struct study_result *result,
                         const struct table_style *style)
{
    const struct case_file *file = &study->settings.file;
    const bool random = settings_random_start(&result->settings), many = study->replicates > 1;
    bool any = false;
    for (int field = 0; field < FIELDS; field++) any = any || measured(file, result, field);
    if (any)
        printf("%serrors: L1 = sum V|q - exact|/sum V over the measure window, volumes cut at its "
               "edge, code units; h: mean there%s\n",
               style->faint, style->end);
    else
        printf("%sno errors of fields: after the start nothing is exact%s\n", style->faint,
               style->end);
    if (many)
        printf("%sgeometric means of %zu runs, %s, and their standard deviation%s\n", style->faint,
               study->replicates, random ? "each with another seed" : "with n nearby", style->end);
    if (!any) return;
    print_orders(file, result, style);
    printf("%sorder: least squares of log(error) against log(box/n), Student t%s%s\n", style->faint,
           many ? ", weights and intervals from the deviations" : "", style->end);
}

static void print_study(const struct study *study, const struct study_result *result,
                        const char *label, const struct options *options)
{
    const struct table_style style = table_style(options->color);
    const struct case_file *file = &study->settings.file;
    char interpolation[400];
    printf("%s%s%s: %s%s%s\n", style.bold, file->name, style.end, file->title, *label ? ", " : "",
           label);
    print_ladder(study, result, &style);
    print_errors(study, result, &style);
    if (!study->settings.external) print_floor(result, &style);
    print_functionals(result, &style);
    print_kept(result, &style);
    print_budget(result, &style);
    run_interpolation_text(result->interpolation, interpolation, sizeof interpolation);
    if (interpolation[0]) printf("%s\n", interpolation);
    if (result->suspicion[0])
        printf("%ssuspicious: %s%s\n", style.bad, result->suspicion, style.end);
    printf("\n");
}

static void print_all(const struct study *study, const struct options *options)
{
    for (size_t c = 0; c < study->sweep.count; c++) {
        const struct study_result *result = &study->results[c];
        char label[SWEEP_LABEL];
        sweep_label(&study->sweep, c, label);
        if (result->excluded)
            printf("%s: excluded: %s\n\n", label, result->message);
        else if (result->status == STATUS_BROKE_DOWN)
            printf("%s%s%s: %s\n\n", label, *label ? ": " : "",
                   study->settings.external ? "failed" : "broke down", result->message);
        else
            print_study(study, result, label, options);
    }
    const struct table_style style = table_style(options->color);
    if (study->suspicion[0]) printf("%ssuspicious: %s%s\n", style.bad, study->suspicion, style.end);
}

static enum status take_replicates(struct study *study, const struct options *options,
                                   struct error *error)
{
    const char *text = options_value(options, "replicates");
    double replicates = (double)study_replicates(&study->settings);
    for (size_t k = 0; k < study->sweep.key_count; k++) {
        if (study->sweep.keys[k].key != SETTING_seed) continue;
        if (text)
            return error_set(error, STATUS_BAD_INPUT,
                             "converge: --replicates and --vary seed exclude each other");
        replicates = 1;
    }
    if (options_number(options, "replicates", true, 1, STUDY_REPLICATES_MAX, &replicates, error))
        return error->status;
    study->replicates = (size_t)replicates;
    return STATUS_OK;
}

/* Runs and judges the study and fills the document. *whole: see sharing_run. */
static enum status compute(struct study *study, const struct options *options,
                           struct sharing *sharing, json_t *document, bool *whole,
                           struct error *error)
{
    struct pool pool = {0};
    enum status status = study_plan(study, &pool, error);
    if (!status) status = sharing_run(sharing, &pool, options, whole, error);
    if (*whole) status = study_judge(study, &pool, error);
    pool_free(&pool);
    if (status || !*whole) return status;
    if (study->status == STATUS_BROKE_DOWN)
        result_add(document, "status=%s", study->settings.external ? "failed" : "broke_down");
    study_add_json(study, document);
    const char *message = json_string_value(json_object_get(document, "message"));
    return study->status == STATUS_BROKE_DOWN
               ? error_set(error, STATUS_BROKE_DOWN, "%s", message ? message : "")
               : study->status;
}

static enum status converge(const struct options *options, int n, char **arguments,
                            struct code *code, struct error *error)
{
    struct study study = {0};
    struct sharing sharing;
    struct code_external external;
    bool whole = false;
    if (options_case(options, arguments[0], n - 1, arguments + 1, code, &external, &study.settings,
                     error) ||
        sweep_parse(&study.sweep, options_value(options, "vary"), error) ||
        options_ladder(options, &study.settings, ORDER_LEVELS_MIN, study.ladder, &study.level_count,
                       error) ||
        take_replicates(&study, options, error) || sharing_take(&sharing, options, 0, NULL, error))
        return error->status;
    json_t *document = result_new("converge");
    result_add(document, "case=%s status=%s", study.settings.file.name, "ok");
    struct run_settings of_all = study.settings;
    struct run as_given;
    struct error trouble = {0};
    of_all.settings.shared = true;
    if (!run_resolve(&as_given, &of_all, &trouble))
        json_object_set_new(document, "settings", settings_json(&as_given.settings));
    if (study.settings.external) external.base.describe(&external.base, document);
    enum status status = compute(&study, options, &sharing, document, &whole, error);
    const bool sound = status == STATUS_OK || status == STATUS_CHECK_FAILED;
    const bool told = whole && (sound || status == STATUS_BROKE_DOWN);
    if (options->speak && told) print_all(&study, options);
    if (!told)
        json_decref(document);
    else if (options_write(options, document, error))
        status = error->status;
    study_free(&study);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct code code = {0};
    if (n < 1) return command_usage(options, error, "a case is needed (`sphproof list cases`)");
    const enum status status = converge(options, n, arguments, &code, error);
    code_free(&code);
    return status;
}

static const struct command_option own_options[] = {
    {"n", "N1,N2,...", "numbers of particles, at least four distinct ones (default: the case's)"},
    {"vary", "KEY[=A,B][,...]",
     "repeat the ladder for every member of a family, or for these values"},
    {"replicates", "R",
     "runs of each level: with other seeds if the start is random (default 3; 1 for "
     "lattice=jittered without jitter in 2D and 3D), else with other n: in 1D within 2.5 %, at "
     "least one particle apart (default 9, for smooth solutions 1), in 2D and 3D lattices with "
     "one row more, one less ... (default 1)"},
    {"jobs", "J", "number of runs side by side (default 1); results do not depend on it"},
    {"code", "CODE.ini", CODE_OPTION_HELP},
    {"work", "DIR", CODE_WORK_HELP},
    SHARING_OPTIONS,
    {NULL, NULL, NULL},
};

const struct command command_converge = {
    .name = "converge",
    .synopsis = "CASE [KEY=VALUE ...]",
    .help = "a ladder of resolutions: orders with 95 % intervals, and the case's gates\nA gate "
            "passes if the order lies inside it, half of the order's interval is at most 0.15, "
            "and\nthe error at the finest level is below its bound; some gates have a bound "
            "alone.\nExit status 1: a gate failed.",
    .run = run,
    .options = own_options,
    .examples = "sphproof converge sod\n"
                "sphproof converge sod --n 100,200,400,800 kernel=cubic_spline eta=2\n"
                "sphproof converge sod --vary kernel=cubic_spline,wendland_c2,gradient\n"
                "sphproof converge sound_wave jitter=0.1 --replicates 5 --jobs 2\n"
                "sphproof converge gresho --cache shared --shard 1/2   # 2/2 on another machine\n"
                "sphproof converge gresho --code mine.ini --jobs 4 --cache kept\n"
                "sphproof converge sound_wave --json orders.json",
};
