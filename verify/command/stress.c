/* SPDX-License-Identifier: GPL-3.0-or-later
 * sphproof stress: tests numerical stability, and reports where and how schemes break down. */
#include "stress.h"

#include <gsl/gsl_errno.h>
#include <stdio.h>
#include <string.h>

#include "command.h"
#include "result.h"
#include "sharing.h"
#include "table.h"
#include "value.h"

enum { CELL = 12, SHOWN = 12 };

static const char *style_of(const struct table_style *style, const char *outcome)
{
    return !strcmp(outcome, "ok") ? style->good : !strcmp(outcome, "broke_down") ? style->bad : "";
}

/* Prints "ok 3.6e-3", "broke down", ... for one cell. */
static void print_cell(const json_t *entry, int width, const struct table_style *style)
{
    const char *outcome = value_text(entry, "outcome");
    const json_t *measured = json_object_get(entry, "measured"),
                 *predicted = json_object_get(entry, "predicted");
    char text[40] = "";
    if (json_is_number(measured) && json_is_number(predicted))
        snprintf(text, sizeof text, "%.3f/%.3f", json_number_value(measured),
                 json_number_value(predicted));
    else if (json_is_number(measured) || json_is_number(predicted))
        snprintf(text, sizeof text, "%s%.3g", strcmp(outcome, "ok") ? "~" : "",
                 json_number_value(json_is_number(measured) ? measured : predicted));
    else
        snprintf(text, sizeof text, "%s", strcmp(outcome, "broke_down") ? outcome : "broke");
    printf(" %s%*s%s", style_of(style, outcome), width, text, style->end);
}

static void print_group(const json_t *group, const json_t *cells, const struct table_style *style)
{
    const json_t *rows = json_object_get(group, "rows"),
                 *columns = json_object_get(group, "columns"), *entry;
    const char *name = value_text(group, "name");
    size_t i, shown = 0, width = CELL;
    json_array_foreach(columns, i, entry)
        if (json_string_length(entry) > width) width = json_string_length(entry);
    printf("\n%s%s%s: %s\n%-24s", style->bold, name, style->end, value_text(group, "title"),
           value_text(group, "column_title"));
    for (i = 0; i < json_array_size(columns); i++)
        printf(" %*s", (int)width, json_string_value(json_array_get(columns, i)));
    for (size_t r = 0; r < json_array_size(rows); r++) {
        const char *row = json_string_value(json_array_get(rows, r));
        printf("\n%-24.24s", row);
        json_array_foreach(cells, i, entry)
            if (!strcmp(value_text(entry, "group"), name) && !strcmp(value_text(entry, "row"), row))
                print_cell(entry, (int)width, style);
    }
    printf("\n");
    json_array_foreach(cells, i, entry) {
        if (strcmp(value_text(entry, "group"), name) || !strcmp(value_text(entry, "outcome"), "ok"))
            continue;
        if (shown++ == SHOWN) break;
        printf("  %s%s, %s: %s%s\n    %s\n", style->faint, value_text(entry, "row"),
               value_text(entry, "column"), value_text(entry, "reason"), style->end,
               value_text(entry, "command"));
    }
    if (shown > SHOWN) printf("  ... all of them with --json\n");
}

static void print_all(const json_t *document, size_t wrong, const struct options *options)
{
    const struct table_style style = table_style(options->color);
    const json_t *groups = json_object_get(document, "groups"), *group, *value;
    const json_t *comparison = json_object_get(document, "comparison");
    size_t i;
    const char *name;
    json_array_foreach(groups, i, group)
        print_group(group, json_object_get(document, "cells"), &style);
    printf("\n%sdefault scheme against the seed program's method:%s", style.bold, style.end);
    json_object_foreach((json_t *)comparison, name, value)
        if (json_is_integer(value)) printf(" %s %lld;", name, (long long)json_integer_value(value));
    printf("\n%s%s%s: numbers are errors (density, relative), or measured/predicted limits; ~ is "
           "inaccurate\n",
           wrong ? style.bad : style.good, wrong ? "NOT WELL" : "all as it should be", style.end);
}

static enum status compute(struct stress *stress, struct pool *pool, struct sharing *sharing,
                           const struct options *options, struct error *error)
{
    bool whole;
    enum status status = sharing_run(sharing, pool, options, &whole, error);
    if (!whole) return status;
    json_t *document = result_new("stress");
    const size_t wrong = stress_judge(stress, pool, document);
    if (options->speak) print_all(document, wrong, options);
    status = options_write(options, document, error);
    return !status && wrong ? STATUS_CHECK_FAILED : status;
}

static enum status run(const struct options *options, int n, char **arguments, struct error *error)
{
    struct stress stress;
    struct pool pool = {0};
    struct sharing sharing;
    const bool nightly = options_value(options, "nightly");
    if (nightly && options_value(options, "quick"))
        return error_set(error, STATUS_BAD_INPUT,
                         "stress: --quick and --nightly exclude each other");
    if (sharing_take(&sharing, options, options->threads, NULL, error)) return error->status;
    enum status status = stress_plan(&stress, nightly, (size_t)n, arguments, &pool, error);
    if (!status) {
        gsl_set_error_handler_off();
        status = compute(&stress, &pool, &sharing, options, error);
        stress_free(&stress);
    }
    pool_free(&pool);
    return status;
}

static const struct command_option own_options[] = {
    {"quick", NULL, "under a minute (default)"},
    {"nightly", NULL, "more cells, a million steps"},
    {"jobs", "J", "number of cells side by side (default: --threads)"},
    SHARING_OPTIONS,
    {NULL, NULL, NULL},
};

const struct command command_stress = {
    .name = "stress",
    .synopsis = "[GROUP ...]",
    .help =
        "numerical stability: what survives, where it breaks and how\n"
        "Linear theory (limits of eta, time steps) with noise runs that confirm it, and hard\n"
        "problems: each cell ends ok, inaccurate or broke_down, with a reason and the command\n"
        "that does it again. Exit status 1: a prediction fails, a fault went unnoticed, or the\n"
        "default scheme breaks down where the seed program's method does not.",
    .run = run,
    .options = own_options,
    .examples = "sphproof stress\nsphproof stress limits shock\n"
                "sphproof stress --nightly --json stress.json",
};
