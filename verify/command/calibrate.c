/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof calibrate: measures bounds for the gates of a code file. */
#include "calibrate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "output.h"
#include "result.h"
#include "sharing.h"
#include "table.h"

enum { RUNS = 4 };

/* Sets the path of the result, NAME.calibrated.ini or that of --out, which must be in the code
 * file's folder, because paths in code files are relative to that folder. */
static enum status take_out(const struct options *options, const struct code *code,
                            char out[CODE_PATH], struct error *error)
{
    const char *said = options_value(options, "out"), *dot = strrchr(code->path, '.');
    const char *slash = strrchr(code->path, '/');
    const int stem = dot && dot > (slash ? slash : code->path) ? (int)(dot - code->path)
                                                               : (int)strlen(code->path);
    if (said)
        snprintf(out, CODE_PATH, "%s", said);
    else
        snprintf(out, CODE_PATH, "%.*s.calibrated.ini", stem, code->path);
    char *base = strrchr(out, '/'), folder[CODE_PATH];
    snprintf(folder, sizeof folder, "%.*s", base ? (int)(base - out) : 1, base ? out : ".");
    char *real = realpath(*folder ? folder : "/", NULL);
    const bool beside = real && strcmp(real, code->folder) == 0;
    free(real);
    if (!beside)
        return error_set(error, STATUS_BAD_INPUT,
                         "calibrate: --out '%.200s': allowed: a file in the folder of %.200s, as "
                         "paths in code files are relative to them",
                         out, code->path);
    return output_probe(out, error);
}

static enum status take_runs(const struct options *options, size_t *runs, struct error *error)
{
    double number = RUNS;
    if (options_number(options, "runs", true, 2, CALIBRATE_RUNS_MAX, &number, error))
        return error->status;
    *runs = (size_t)number;
    return STATUS_OK;
}

/* ---- for a person ---- */

static void print_gate(const struct calibrate *calibrate, const struct calibrate_gate *gate,
                       const struct table_style *style)
{
    printf("%-22s %12.4e %9.1e  ", gate->name, gate->value, gate->floor);
    if (gate->sight == CALIBRATE_BLIND) {
        printf("%ssees no fault%s\n", style->bad, style->end);
        return;
    }
    printf("%11.4e %11.4e  ", gate->least, gate->bound);
    if (gate->smallest >= 0)
        printf("%s %.1e", calibrate->code->faults[gate->smallest].name,
               gate->change[gate->smallest]);
    else
        printf("%sno fault was planted%s", style->faint, style->end);
    if (isfinite(gate->low)) printf(", order in [%g, %g]", gate->low, gate->high);
    if (gate->order_lost)
        printf(", %snot all runs have the order that was asked for: left out%s", style->bad,
               style->end);
    printf("\n");
}

static void print_fault(const struct calibrate *calibrate, const struct calibrate_case *one,
                        size_t f, const struct table_style *style)
{
    printf("fault %-16s ", calibrate->code->faults[f].name);
    if (one->breaks[f])
        printf("its runs fail: %.200s", one->studies[calibrate->runs + f].results[0].message);
    else
        printf("%s%s%s", one->seen[f] ? style->good : style->bad,
               one->seen[f] ? "seen by" : "seen by no gate", style->end);
    for (size_t g = 0; g < one->gate_count; g++)
        if (one->gates[g].sees[f]) printf(" %s", one->gates[g].name);
    printf("\n");
}

static void print_case(const struct calibrate *calibrate, const struct calibrate_case *one,
                       const struct options *options)
{
    const struct table_style style = table_style(options->color);
    const struct case_file *file = &one->of->file;
    printf("%s%s%s: %s, %zu runs, at n = %zu\n", style.bold, file->asked, style.end, file->title,
           calibrate->runs, file->ladder[file->ladder_count - 1]);
    printf("%s%-22s %12s %9s  %11s %11s  %s%s\n", style.bold, "gate", "value", "floor", "least",
           "bound", "smallest fault that is seen", style.end);
    for (size_t g = 0; g < one->gate_count; g++) print_gate(calibrate, &one->gates[g], &style);
    for (size_t f = 0; f < calibrate->code->fault_count; f++)
        print_fault(calibrate, one, f, &style);
    if (one->trouble[0])
        printf("%sa report fails whatever the gates are: %s%s\n", style.bad, one->trouble,
               style.end);
    printf("\n");
}

/* ---- the command ---- */

/* Writes the file, and reads it back as the program would. */
static enum status write_code(const struct calibrate *calibrate, const char *out,
                              struct error *error)
{
    struct code again;
    char *text;
    if (calibrate_text(calibrate, &text, error)) return error->status;
    enum status status = output_text(out, text, error);
    free(text);
    if (status) return status;
    status = code_load(&again, out, error);
    if (!status) code_free(&again);
    return status;
}

static enum status calibrate_code(const struct options *options, const struct code *code, int n,
                                  char **names, struct error *error)
{
    struct calibrate calibrate = {0};
    struct sharing sharing;
    struct pool pool = {0};
    char out[CODE_PATH];
    size_t runs = 0;
    bool whole = false;
    if (take_runs(options, &runs, error) || take_out(options, code, out, error) ||
        sharing_take(&sharing, options, 0, NULL, error))
        return error->status;
    enum status status = calibrate_plan(&calibrate, code, runs, (size_t)n, names, &pool, error);
    if (!status) status = sharing_run(&sharing, &pool, options, &whole, error);
    if (whole) status = calibrate_judge(&calibrate, &pool, error);
    const bool sound = whole && (status == STATUS_OK || status == STATUS_CHECK_FAILED);
    struct error trouble = {0};
    if (sound && write_code(&calibrate, out, &trouble)) *error = trouble, status = trouble.status;
    if (sound && !trouble.status) {
        json_t *document = result_new("calibrate");
        calibrate_add_json(&calibrate, document);
        result_add(document, "out=%s status=%s", out, status == STATUS_OK ? "pass" : "fail");
        for (size_t c = 0; options->speak && c < calibrate.count; c++)
            print_case(&calibrate, &calibrate.cases[c], options);
        if (options->speak) printf("written: %s\n", out);
        if (options_write(options, document, error)) status = error->status;
    }
    calibrate_free(&calibrate);
    pool_free(&pool);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct code code;
    if (n < 1) return command_usage(options, error, "a code file is needed");
    if (code_load(&code, arguments[0], error)) return error->status;
    const enum status status = calibrate_code(options, &code, n - 1, arguments + 1, error);
    code_free(&code);
    return status;
}

static const struct command_option own_options[] = {
    {"out", "FILE", "the code file that is written (default: NAME.calibrated.ini beside CODE.ini)"},
    {"runs", "N", "runs of each case without a fault (default 4)"},
    {"jobs", "J", "number of runs side by side (default 1); results do not depend on it"},
    SHARING_OPTIONS,
    {NULL, NULL, NULL},
};

const struct command command_calibrate = {
    .name = "calibrate",
    .synopsis = "CODE.ini [CASE ...]",
    .help = "bounds for another code's gates: above the scatter of round-off, below the effect of "
            "faults\nEach case (default: all of the file) is run several times, with starts that "
            "differ by 2\nunits in the last place, other seeds, and other numbers of @THREADS@; "
            "then with each\n[fault NAME] of the code file. The gates that are written into a copy "
            "of the file lie between\nthe two, with a least and a greatest error. A figure that no "
            "fault changes gets no gate.\nThe exit status is 1 if no gate sees some fault.",
    .run = run,
    .options = own_options,
    .examples = "sphproof calibrate mine.ini\n"
                "sphproof calibrate mine.ini sod gresho --runs 6 --jobs 4 --cache kept\n"
                "sphproof calibrate mine.ini --out bounds.ini --json found.json",
};
