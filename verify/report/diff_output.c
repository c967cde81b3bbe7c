/* SPDX-License-Identifier: GPL-3.0-or-later
 * Differences as a table and as JSON. */
#include "diff.h"

#include <math.h>
#include <stdio.h>

#include "result.h"
#include "table.h"

enum { LINES_MAX = 60 };

/* new/old; NaN if the ratio has no meaning. */
static double ratio_of(const struct difference *d)
{
    if (!d->old || !d->new || d->old->word || d->new->word) return (double)NAN;
    return d->new->value / d->old->value;
}

/* The best value of a figure: 0 for an error, the exact value of a functional; NaN if unknown. */
static double exact_of(const struct difference *d)
{
    switch (d->any->kind) {
    case METRIC_ERROR:
    case METRIC_CHECK:
    case METRIC_PART:
        return 0;
    case METRIC_EXACT:
        return d->any->exact;
    default:
        return (double)NAN;
    }
}

/* ---- JSON ---- */

static json_t *value_json(const struct metric *metric)
{
    if (!metric) return json_null();
    return metric->word ? json_string(metric->word) : result_number(metric->value);
}

json_t *diff_figures_json(const struct diff *diff, size_t most)
{
    json_t *figures = json_array();
    for (size_t i = 0; i < diff->count && i < most; i++) {
        const struct difference *d = &diff->list[i];
        json_array_append_new(
            figures,
            result_object("path=%s old=%p new=%p exact=%g? ratio=%g? verdict=%s regression=%d?",
                          d->any->path, (void *)value_json(d->old), (void *)value_json(d->new),
                          exact_of(d), ratio_of(d), metric_verdicts[d->verdict], d->regression));
    }
    return figures;
}

void diff_add_json(const struct diff *diff, json_t *document)
{
    json_t *summary = json_object();
    for (int v = 0; v < METRIC_VERDICTS; v++)
        json_object_set_new(summary, metric_verdicts[v],
                            json_integer((json_int_t)diff->verdicts[v]));
    result_add(summary, "regressions=%zu compared=%zu left_out=%zu", diff->regressions,
               diff->compared, diff->left_out);
    if (diff->left_out_times) result_add(summary, "left_out_times=%zu", diff->left_out_times);
    result_add(document, "status=%s problem=%s figures=%p summary=%p", diff->well ? "pass" : "fail",
               diff->problem, (void *)diff_figures_json(diff, diff->count), (void *)summary);
}

/* ---- table ---- */

static void print_value(const struct metric *metric)
{
    if (!metric)
        printf(" %13s", "-");
    else if (metric->word)
        printf(" %13s", *metric->word ? metric->word : "\"\"");
    else
        printf(" %13.6g", metric->value);
}

static void print_number(const char *format, int width, double value)
{
    if (isfinite(value))
        printf(format, width, value);
    else
        printf(" %*s", width, "");
}

static void print_difference(const struct difference *d, bool exact,
                             const struct table_style *style)
{
    const char *color =
        d->regression || d->verdict == VERDICT_VANISHED || d->verdict == VERDICT_WORSE ? style->bad
        : d->verdict == VERDICT_BETTER                                                 ? style->good
                                                                                       : "";
    printf("%s%-12s%s", color, d->regression ? "REGRESSION" : metric_verdicts[d->verdict],
           style->end);
    print_value(d->old);
    print_value(d->new);
    if (exact) print_number(" %*.6g", 13, exact_of(d));
    print_number(" %*.4g", 9, ratio_of(d));
    printf("  %s\n", d->any->path);
}

/* Prints the verdict and its reason in one line. */
static void print_verdict(const struct diff *diff, const struct table_style *style)
{
    const size_t regressions = diff->regressions, vanished = diff->verdicts[VERDICT_VANISHED],
                 changed = diff->verdicts[VERDICT_INCOMPARABLE];
    if (diff->well) {
        printf("%swell%s: %zu figures compared, no regression\n", style->good, style->end,
               diff->compared);
        return;
    }
    printf("%sNOT WELL%s: ", style->bad, style->end);
    if (diff->problem[0]) {
        printf("%s\n", diff->problem);
        return;
    }
    const char *comma = "";
    if (regressions)
        printf("%zu regression%s", regressions, regressions > 1 ? "s" : ""), comma = ", ";
    if (vanished)
        printf("%s%zu figure%s vanished: less was compared than before", comma, vanished,
               vanished > 1 ? "s" : ""),
            comma = ", ";
    if (changed)
        printf("%s%zu figure%s changed that ha%s no better or worse", comma, changed,
               changed > 1 ? "s" : "", changed > 1 ? "ve" : "s");
    putchar('\n');
}

void diff_print(const struct diff *diff, double threshold, bool exact, bool color)
{
    const struct table_style style = table_style(color);
    const size_t shown = diff->problem[0] ? 0 : diff->count - diff->verdicts[VERDICT_SAME];
    print_verdict(diff, &style);
    if (shown) {
        printf("%s%-12s %13s %13s", style.bold, "verdict", "old", "new");
        if (exact) printf(" %13s", "exact");
        printf(" %9s  %s%s\n", "ratio", "figure", style.end);
    }
    for (size_t i = 0; i < shown && i < LINES_MAX; i++)
        print_difference(&diff->list[i], exact, &style);
    if (shown > LINES_MAX) printf("... and %zu more (all with --json)\n", shown - LINES_MAX);
    if (diff->problem[0]) return;
    printf("%zu worse, %zu of them regressions (errors by more than %.3g %%, orders beyond their "
           "intervals, new failures);\n%zu better, %zu same, %zu changed, %zu vanished, %zu new",
           diff->verdicts[VERDICT_WORSE], diff->regressions, 100 * threshold,
           diff->verdicts[VERDICT_BETTER], diff->verdicts[VERDICT_SAME],
           diff->verdicts[VERDICT_INCOMPARABLE], diff->verdicts[VERDICT_VANISHED],
           diff->verdicts[VERDICT_NEW]);
    if (diff->left_out) printf("; %zu left out, of runs that broke down", diff->left_out);
    if (diff->left_out_times)
        printf("; %zu times left out, of two processors", diff->left_out_times);
    printf(
        "\n%snoise: errors 0.1 %%, orders their 95 %% intervals, figures of checks a factor of 3 "
        "or ten floors,\nCPU times a factor of 1.5, wall clock 3; timings and counts of work "
        "are never regressions%s\n",
        style.faint, style.end);
}
