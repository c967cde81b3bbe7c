/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof diff: compares the figures of two result documents, before and after a change. */
#include "diff.h"

#include <stdio.h>
#include <string.h>

#include "command.h"
#include "result.h"
#include "text.h"
#include "value.h"

static void print_head(const char *side, const char *path, const json_t *document)
{
    printf("%s  %s: %s of %s, git %s, %s\n", side, path, value_text_or(document, "command", "?"),
           value_text_or(document, "date", "?"), value_text_or(document, "git", "?"),
           value_text_or(document, "compiler", "?"));
}

static json_t *diff_json(const struct diff *diff, const json_t *old, const json_t *new,
                         double threshold)
{
    json_t *document = result_new("diff");
    result_add(document, "of=%s old_git=%s new_git=%s threshold=%g problem=%s",
               value_text_or(new, "command", "?"), value_text_or(old, "git", "?"),
               value_text_or(new, "git", "?"), threshold, diff->problem);
    diff_add_json(diff, document);
    return document;
}

static enum status take_threshold(const struct options *options, double *threshold,
                                  struct error *error)
{
    const char *text = options_value(options, "threshold");
    double percent = 100 * DIFF_THRESHOLD;
    if (text && !(text_real(text, &percent) && percent >= 0 && percent <= 1e6))
        return error_set(error, STATUS_BAD_INPUT,
                         "diff: --threshold '%.40s': allowed: a number of percent from 0 to 1e6",
                         text);
    *threshold = percent / 100;
    return STATUS_OK;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    double threshold = DIFF_THRESHOLD;
    json_t *old = NULL, *new = NULL;
    struct diff diff = {0};
    if (n != 2) return command_usage(options, error, "two result documents are needed");
    if (take_threshold(options, &threshold, error)) return error->status;
    enum status status = result_load(&old, arguments[0], error);
    if (!status) status = result_load(&new, arguments[1], error);
    if (!status) status = diff_documents(old, new, threshold, &diff, error);
    if (status == STATUS_OK || status == STATUS_CHECK_FAILED) {
        if (options->speak) {
            print_head("old", arguments[0], old);
            print_head("new", arguments[1], new);
            diff_print(&diff, threshold, false, options->color);
        }
        if (options_write(options, diff_json(&diff, old, new, threshold), error))
            status = error->status;
        diff_free(&diff);
    }
    json_decref(old);
    json_decref(new);
    return status;
}

static const struct command_option own_options[] = {
    {"threshold", "PERCENT", "by how much an error may grow before it is a regression (default 5)"},
    {NULL, NULL, NULL},
};

const struct command command_diff = {
    .name = "diff",
    .synopsis = "OLD.json NEW.json",
    .help = "what a change did: each figure old, new, ratio, and a verdict against its noise\n\n"
            "Takes two result documents of one command (--json FILE of any of them, results.json "
            "of a\nreport). Entries of lists are found again by what they are about, never by "
            "their place.\nVerdicts: worse, better, same (within noise), incomparable (it changed, "
            "and there is no\nbetter or worse), vanished, new. Exit status 1 unless all is well: a "
            "regression, a figure\nthat vanished or is incomparable, two different problems, "
            "nothing to compare.",
    .run = run,
    .options = own_options,
    .examples = "sphproof diff old/results.json reports/out/results.json\n"
                "sphproof diff before.json after.json --threshold 1 --json diff.json",
};
