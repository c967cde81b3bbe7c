/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof report: computes all results and writes the page, results.json and the files beside
 * them. */
#include "report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "code_run.h"
#include "command.h"
#include "findings.h"
#include "history.h"
#include "output.h"
#include "page.h"
#include "result.h"
#include "sharing.h"
#include "value.h"
#include "verdict.h"

enum { PATH_LENGTH = 4096 };

static const struct command_option report_options[] = {
    {"quick", NULL, "a report that takes two minutes on two cores (the default)"},
    {"nightly", NULL, "one more resolution for every case, and the slow checks"},
    {"out", "DIR", "folder for the report (default: reports/out), made if needed"},
    {"jobs", "J", "number of computations side by side (default: one for each core)"},
    SHARING_OPTIONS_OF_CACHE,
    {"history", "FILE", "file that gets one line each night (default: DIR/history.jsonl)"},
    {"code", "CODE.ini ...",
     "report on the codes that these files describe, in place of our own solver"},
    {"work", "DIR", CODE_WORK_HELP},
    {"resume", NULL, "continue after an interruption with the results in DIR/cache"},
    {"force", NULL, "compute everything, also results that DIR/cache has"},
    {NULL, NULL, NULL},
};

/* Writes text to folder/name. */
static enum status write_text(const char *folder, const char *name, const char *text,
                              struct error *error)
{
    char path[PATH_LENGTH];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory for %s", path);
    return output_text(path, text, error);
}

static enum status write_page(const char *folder, const struct page *page, struct error *error)
{
    enum status status = write_text(folder, "index.html", page->html, error);
    for (size_t k = 0; k < page->plots.file_count && !status; k++) {
        char name[PATH_LENGTH / 4];
        snprintf(name, sizeof name, "plots/%s", page->plots.files[k].name);
        status = write_text(folder, name, page->plots.files[k].bytes, error);
    }
    return status;
}

/* Writes all files of the report. The page comes last, so that its links exist. */
static enum status write_report(const char *folder, const json_t *results, struct page *page,
                                char *summary, struct error *error)
{
    char path[PATH_LENGTH];
    char *junit = findings_junit(findings_of_report, results);
    snprintf(path, sizeof path, "%s/results.json", folder);
    enum status status = result_write(results, path, error);
    if (!status) status = write_text(folder, "junit.xml", junit, error);
    if (!status) status = write_text(folder, "summary.md", summary, error);
    if (!status) status = write_page(folder, page, error);
    free(junit);
    return status;
}

static enum status check_options(const struct options *options, struct error *error)
{
    if (options_value(options, "quick") && options_value(options, "nightly"))
        return error_set(error, STATUS_BAD_INPUT,
                         "report: --quick and --nightly exclude each other");
    if (options_value(options, "code") && options_value(options, "nightly"))
        return error_set(error, STATUS_BAD_INPUT,
                         "report: --nightly and --code exclude each other: a code file says how "
                         "large its runs are");
    if (options_value(options, "work") && !options_value(options, "code"))
        return error_set(error, STATUS_BAD_INPUT, "report: --work needs --code FILE");
    if (options_value(options, "resume") && options_value(options, "force"))
        return error_set(error, STATUS_BAD_INPUT,
                         "report: --resume and --force exclude each other");
    return STATUS_OK;
}

/* Paths of the report: in one folder, except a history that the user places elsewhere. */
struct paths {
    const char *folder, *history;
    char plots[PATH_LENGTH], cache[PATH_LENGTH], nights[PATH_LENGTH];
};

/* Fills the paths; creates nothing. */
static enum status take_paths(const struct options *options, struct paths *paths,
                              struct error *error)
{
    const char *folder = options_value(options, "out");
    paths->folder = folder ? folder : "reports/out";
    paths->history = options_value(options, "history");
    if (!paths->history) paths->history = paths->nights;
    if (strlen(paths->folder) > PATH_LENGTH - 64)
        return error_set(error, STATUS_BAD_INPUT, "report: --out: the path is too long");
    snprintf(paths->plots, PATH_LENGTH, "%s/plots", paths->folder);
    snprintf(paths->cache, PATH_LENGTH, "%s/cache", paths->folder);
    snprintf(paths->nights, PATH_LENGTH, "%s/history.jsonl", paths->folder);
    return STATUS_OK;
}

/* Judges all results, with the history and the verdict, which depends on it; the caller owns
 * them. */
static enum status judge(struct report *report, const struct paths *paths, json_t **results,
                         struct error *error)
{
    json_t *told;
    enum status status = report_judge(report, paths->folder, results, error);
    if (status) return status;
    if (!(status = history_tell(*results, paths->history, &told, error))) {
        json_object_set_new(*results, "history", told);
        if (json_object_set_new(*results, "verdict", verdict_make(*results)))
            status = error_set(error, STATUS_ENVIRONMENT, "no memory for the verdict");
    }
    if (status) json_decref(*results);
    return status;
}

/* Removes cache entries that were not used for a month, once a night. */
static enum status prune(const struct paths *paths, const struct options *options,
                         struct error *error)
{
    struct cache_census census;
    if (!options_value(options, "nightly")) return STATUS_OK;
    if (cache_prune(paths->cache, CACHE_MONTH, &census, error)) return error->status;
    if (census.removed && options->speak)
        printf("%zu results that nobody has used for a month were removed from %s\n",
               census.removed, paths->cache);
    return STATUS_OK;
}

static void speak(const json_t *results, const char *summary, const char *folder)
{
    char absolute[PATH_LENGTH];
    printf("%s\n%.0f computations, %.0f of them found in %s/cache; %.1f s\n"
           "report: %s/index.html\n",
           summary, value_member(results, "computations"), value_member(results, "found"), folder,
           value_member(results, "seconds"), realpath(folder, absolute) ? absolute : folder);
}

/* Prints the verdict and returns it as a status, after everything that can fail. */
static enum status tell(const struct options *options, const json_t *results,
                        const struct paths *paths, struct error *error)
{
    struct page page;
    enum status status = STATUS_OK;
    char *summary = summary_text(results);
    if (!page_make(&page, results) || !summary)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for the page");
    if (!status) status = write_report(paths->folder, results, &page, summary, error);
    if (!status) status = history_append(results, paths->history, error);
    if (!status && options->json) status = result_write(results, options->json, error);
    if (!status && options->speak) speak(results, summary, paths->folder);
    if (!status && page.plots.missing)
        status = error_set(error, STATUS_ENVIRONMENT, "%zu plots are missing: %s",
                           page.plots.missing, page.plots.message);
    if (!status) status = prune(paths, options, error);
    page_free(&page);
    free(summary);
    if (status) return status;
    const char *verdict = value_text(json_object_get(results, "verdict"), "status");
    return strcmp(verdict, "pass") == 0 ? STATUS_OK : STATUS_CHECK_FAILED;
}

static enum status make(const struct options *options, struct report *report, struct error *error)
{
    struct paths paths;
    struct sharing sharing;
    json_t *results;
    bool whole;
    const int cores = (int)sysconf(_SC_NPROCESSORS_ONLN);
    if (take_paths(options, &paths, error) ||
        sharing_take(&sharing, options, cores, paths.cache, error))
        return error->status;
    if (!sharing.list && (output_folder(paths.plots, error) || output_probe(paths.history, error)))
        return error->status;
    if (sharing_run(&sharing, report_pool(report), options, &whole, error)) return error->status;
    if (!whole) return STATUS_OK;
    if (judge(report, &paths, &results, error)) return error->status;
    const enum status status = tell(options, results, &paths, error);
    json_decref(results);
    return status;
}

/* ---- other codes ---- */

struct codes {
    size_t count;
    struct code code[REPORT_CODES_MAX];
    struct code_external *externals[REPORT_CODES_MAX];
    struct run_settings *settings[REPORT_CODES_MAX];
    char option[REPORT_CODES_MAX][PATH_LENGTH];
    struct report_code of[REPORT_CODES_MAX];
};

static void codes_free(struct codes *codes)
{
    for (size_t k = 0; codes && k < codes->count; k++) {
        code_free(&codes->code[k]);
        free(codes->externals[k]), free(codes->settings[k]);
    }
    free(codes);
}

static enum status add_code(struct codes *codes, const char *path, const struct options *options,
                            struct error *error)
{
    const size_t k = codes->count;
    struct code *code = &codes->code[k];
    if (k == REPORT_CODES_MAX)
        return error_set(error, STATUS_BAD_INPUT, "report: more than %d times --code",
                         REPORT_CODES_MAX);
    if (code_load(code, path, error)) return error->status;
    codes->count++;
    struct code_external *externals = codes->externals[k] =
        calloc(code->case_count, sizeof *externals);
    struct run_settings *settings = codes->settings[k] = calloc(code->case_count, sizeof *settings);
    if (!externals || !settings)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the cases of %.200s", path);
    for (size_t c = 0; c < code->case_count; c++) {
        if (code_plan(code, code->cases[c].file.asked, options_value(options, "work"), 0, NULL,
                      &externals[c], &settings[c], error))
            return error->status;
        settings[c].threads = options->threads;
    }
    snprintf(codes->option[k], PATH_LENGTH, " --code %s", path);
    codes->of[k] = (struct report_code){code->way.value[CODE_title], codes->option[k],
                                        code->case_count, settings};
    for (size_t i = 0; i < k; i++)
        if (strcmp(codes->of[i].title, codes->of[k].title) == 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "report: two codes are called '%.60s'; allowed: a title each",
                             codes->of[k].title);
    return STATUS_OK;
}

static enum status take_codes(const struct options *options, struct codes **codes,
                              struct error *error)
{
    const char *given = options_value(options, "code");
    char *paths = strdup(given), *rest = paths;
    enum status status = STATUS_OK;
    *codes = calloc(1, sizeof **codes);
    if (!paths || !*codes) status = error_set(error, STATUS_ENVIRONMENT, "no memory for codes");
    for (char *path; !status && (path = strtok_r(rest, "\n", &rest));)
        status = add_code(*codes, path, options, error);
    free(paths);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct report *report = NULL;
    struct codes *codes = NULL;
    if (n) return command_usage(options, error, "no argument is known: '%.40s'", arguments[0]);
    if (check_options(options, error)) return error->status;
    enum status status;
    if (!options_value(options, "code"))
        status = report_create(options_value(options, "nightly"), NULL, 0, &report, error);
    else if (!(status = take_codes(options, &codes, error)))
        status = report_create(false, codes->of, codes->count, &report, error);
    if (!status) status = make(options, report, error);
    report_destroy(report);
    codes_free(codes);
    return status;
}

const struct command command_report = {
    .name = "report",
    .synopsis = "[--quick|--nightly] [--out DIR] [--jobs J] [--shard I/N] [--resume|--force]",
    .help = "everything on one page: cases, convergence, kernels, checks\n\nWrites index.html "
            "(self-contained), results.json, junit.xml, summary.md and the data\nand script of "
            "each plot. Exit status 1 if anything on the page failed.\nEach result is kept as soon "
            "as it is computed: after an interruption, or in a night in\nwhich nothing has "
            "changed, only missing results are computed.\nDIR/faults.json and DIR/score.json, "
            "which verify/test/faults.py and\nverify/mutants/score write, are shown if they exist.",
    .run = run,
    .options = report_options,
    .examples =
        "sphproof report\nsphproof report --code mine.ini --code theirs.ini --out codes\nsphproof "
        "report --nightly --out /tmp/report --jobs 2\n"
        "sphproof report --nightly --out shared --shard 3/8   # on the third machine of eight",
};
