/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof baseline: accepts figures, each time with a reason. A baseline file keeps the document
 * that it was made from and all reasons so far. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "diff.h"
#include "result.h"

static const char default_results[] = "reports/out/results.json",
                  default_file[] = "reports/out/baseline.json";

static enum status check_options(const struct options *options, int n, struct error *error)
{
    const char *accept = options_value(options, "accept"),
               *reason = options_value(options, "reason");
    if (n > 1) return command_usage(options, error, "one result document at most");
    if (accept && (!reason || !reason[strspn(reason, " \t\n")]))
        return error_set(error, STATUS_BAD_INPUT,
                         "baseline: --accept needs a reason: --accept --reason \"why the figures "
                         "may change\"");
    if (reason && !accept)
        return error_set(error, STATUS_BAD_INPUT, "baseline: --reason goes with --accept only");
    return STATUS_OK;
}

/* Loads the baseline; *baseline stays NULL if there is none yet. */
static enum status load_baseline(const char *path, json_t **baseline, struct error *error)
{
    if (access(path, F_OK) && errno == ENOENT) return STATUS_OK;
    const enum status status = result_load(baseline, path, error);
    if (status) return status;
    const char *command = json_string_value(json_object_get(*baseline, "command"));
    if (strcmp(command, "baseline") == 0 && json_is_object(json_object_get(*baseline, "document")))
        return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT, "'%.200s': a document of %.40s, not %s baseline",
                     path, command, strcmp(command, "baseline") ? "a" : "a whole");
}

/* A copy without large members that hold no figures. */
static json_t *figures_of(const json_t *results)
{
    json_t *copy = json_deep_copy(results), *run;
    size_t i;
    json_object_del(copy, "history");
    json_array_foreach(json_object_get(copy, "runs"), i, run) {
        json_object_del(run, "profile");
        json_object_del(run, "through_time");
    }
    return copy;
}

static json_t *new_baseline(const json_t *old, const json_t *results, const char *reason,
                            size_t changed)
{
    json_t *baseline = result_new("baseline"), *accepted;
    accepted = old ? json_deep_copy(json_object_get(old, "accepted")) : json_array();
    json_t *entry = result_object("reason=%s changed=%zu", reason, changed);
    json_object_set(entry, "date", json_object_get(baseline, "date"));
    json_object_set(entry, "git", json_object_get(results, "git"));
    json_array_append_new(accepted, entry);
    json_object_set_new(baseline, "accepted", accepted);
    json_object_set_new(baseline, "document", figures_of(results));
    return baseline;
}

/* An empty document of the same command: without a baseline every figure is new. */
static json_t *nothing_like(const json_t *results)
{
    json_t *empty = json_object();
    json_object_set(empty, "command", json_object_get(results, "command"));
    return empty;
}

static enum status accept(const struct options *options, const char *file, const json_t *baseline,
                          const json_t *results, const struct diff *diff, struct error *error)
{
    const size_t changed = diff->count - diff->verdicts[VERDICT_SAME];
    const char *reason = options_value(options, "reason");
    json_t *made = new_baseline(baseline, results, reason, changed);
    const enum status status = result_write(made, file, error);
    json_decref(made);
    if (!status) /* printed despite --quiet: a baseline never changes silently */
        fprintf(stderr, "sphproof: baseline %s accepted: %zu of %zu figures differ; reason: %s\n",
                file, changed, diff->count, reason);
    return status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    const char *file = options_value(options, "file");
    const char *path = n ? arguments[0] : default_results;
    json_t *baseline = NULL, *results = NULL;
    struct diff diff = {0};
    if (!file) file = default_file;
    enum status status = check_options(options, n, error);
    if (!status) status = result_load(&results, path, error);
    if (!status) status = load_baseline(file, &baseline, error);
    if (!status && !baseline && !options_value(options, "accept"))
        status = error_set(error, STATUS_BAD_INPUT,
                           "there is no baseline '%.200s' yet: --accept --reason \"...\" makes one",
                           file);
    if (!status) {
        json_t *old =
            baseline ? json_incref(json_object_get(baseline, "document")) : nothing_like(results);
        status = diff_documents(old, results, DIFF_THRESHOLD, &diff, error);
        if (!baseline && status == STATUS_CHECK_FAILED)
            status = STATUS_OK; /* every figure is new */
        json_decref(old);
    }
    if (status == STATUS_OK || status == STATUS_CHECK_FAILED) {
        if (options->speak && baseline) diff_print(&diff, DIFF_THRESHOLD, true, options->color);
        json_t *document = result_new("baseline");
        diff_add_json(&diff, document);
        if (options_write(options, document, error)) status = error->status;
        if (options_value(options, "accept") && status <= STATUS_CHECK_FAILED)
            status = accept(options, file, baseline, results, &diff, error);
        if (options->speak && !baseline && !status)
            printf("a first baseline: %zu figures\n", diff.count);
        diff_free(&diff);
    }
    json_decref(baseline);
    json_decref(results);
    return status;
}

static const struct command_option own_options[] = {
    {"file", "FILE", "the baseline (default: reports/out/baseline.json)"},
    {"accept", NULL, "make these results the baseline"},
    {"reason", "TEXT", "why; the file keeps all reasons"},
    {NULL, NULL, NULL},
};

const struct command command_baseline = {
    .name = "baseline",
    .synopsis = "[RESULTS.json] [--accept --reason TEXT]",
    .help = "accepted figures: compares new ones with them, and replaces them only with a "
            "reason\n\nRESULTS.json: any result document (default: reports/out/results.json). "
            "Without --accept it\nonly compares; exit status 1 if there is a regression, or if "
            "less is compared than before.",
    .run = run,
    .options = own_options,
    .examples = "sphproof baseline\n"
                "sphproof baseline --accept --reason \"new default kernel, errors fall by 20 %\"\n"
                "sphproof baseline run.json --file run-baseline.json",
};
