/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "suite_output.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "findings.h"
#include "output.h"
#include "picture.h"
#include "result.h"

enum { SERIES_SHOWN = 8, PATH_LENGTH = 1024 };

/* The figures of one check: suite->figures[begin..end-1]. */
struct tally {
    const struct check *check;
    size_t begin, end, failed, skipped;
    const struct figure *worst;
    double seconds;
};

static struct tally tally_next(const struct suite *suite, size_t begin)
{
    struct tally t = {.check = suite->figures[begin].check, .begin = begin, .end = begin};
    double worst = -1;
    for (; t.end < suite->figure_count && suite->figures[t.end].check == t.check; t.end++) {
        const struct figure *figure = &suite->figures[t.end];
        const double ratio = finding_ratio(figure->value, figure->bound);
        t.seconds += figure->seconds;
        t.failed += figure->status == FINDING_FAIL;
        t.skipped += figure->status == FINDING_SKIP;
        if (figure->status == FINDING_SKIP || !(ratio > worst)) continue;
        worst = ratio;
        t.worst = figure;
    }
    return t;
}

static const char *paint(bool color, const char *code)
{
    return color ? code : "";
}

/* Prints the margin to the bound in words. */
static void print_margin(const struct figure *figure, FILE *stream)
{
    const double ratio = finding_ratio(figure->value, figure->bound);
    if (ratio == 0)
        fprintf(stream, "%10s", "exact");
    else
        fprintf(stream, "%9.3gx", 1 / ratio);
}

static void print_failures(const struct suite *suite, const struct tally *t, FILE *stream)
{
    for (size_t i = t->begin; i < t->end; i++) {
        const struct figure *figure = &suite->figures[i];
        if (figure->status != FINDING_FAIL) continue;
        fprintf(stream, "        %s: got %.6g, bound %.3g, floor %.2g\n", figure->subject,
                figure->value, figure->bound, figure->floor);
    }
    fprintf(stream, "        property: %s\n", t->check->property);
}

static void print_check(const struct suite *suite, const struct tally *t, FILE *stream, bool color,
                        bool details)
{
    const char *end = paint(color, "\033[0m");
    if (!t->worst)
        fprintf(stream, "  %sskip%s  %-28s %s\n", paint(color, "\033[33m"), end, t->check->name,
                suite->figures[t->begin].subject);
    else {
        fprintf(stream, "  %s%s%s  %-28s %11.3g %9.2g ",
                paint(color, t->failed ? "\033[1;31m" : "\033[32m"), t->failed ? "FAIL" : "ok  ",
                end, t->check->name, t->worst->value, t->worst->bound);
        print_margin(t->worst, stream);
        fprintf(stream, " %9.2g %7zu %7.2f\n", t->worst->floor, t->end - t->begin - t->skipped,
                t->seconds);
    }
    if (t->failed && details) print_failures(suite, t, stream);
}

/* Ratio to the bound of the faintest rejected mutant of a check; infinite if the bound is 0 or the
 * figure NaN. */
static double faintest_rejected(const struct suite *suite, const struct check *check)
{
    double least = HUGE_VAL;
    for (size_t i = 0; i < suite->outcome_count; i++) {
        const struct mutant_outcome *o = &suite->outcomes[i];
        if (o->check == check && o->detected)
            least = fmin(least, finding_ratio(o->value, o->bound));
    }
    return least;
}

static void print_mutants(const struct suite *suite, FILE *stream, bool color)
{
    const char *end = paint(color, "\033[0m");
    const struct check *last = NULL;
    fprintf(stream, "\nmutants: faults that the checks must reject\n");
    for (size_t i = 0; i < suite->outcome_count; i++) {
        const struct mutant_outcome *o = &suite->outcomes[i];
        if (o->check != last)
            fprintf(stream, "  %s %s: the faintest rejected one is %.3g x bound\n", o->check->group,
                    o->check->name, faintest_rejected(suite, o->check));
        last = o->check;
        fprintf(stream, "    %s%s%s  %-30s %11.3g %9.2g  %s\n",
                paint(color, o->detected ? "\033[32m" : "\033[1;31m"),
                o->detected ? "caught" : "MISSED", end, o->mutant->name, o->value, o->bound,
                o->mutant->fault);
    }
}

void suite_output_table(const struct suite *suite, FILE *stream, bool color, bool details)
{
    const char *group = "";
    for (size_t i = 0; i < suite->figure_count;) {
        const struct tally t = tally_next(suite, i);
        if (strcmp(group, t.check->group) != 0)
            fprintf(stream, "%s%s%-34s%s %11s %9s %10s %9s %7s %7s\n", *group ? "\n" : "",
                    paint(color, "\033[1m"), t.check->group, paint(color, "\033[0m"), "value",
                    "bound", "margin", "floor", "figures", "s");
        group = t.check->group;
        print_check(suite, &t, stream, color, details);
        i = t.end;
    }
    if (suite->outcome_count) print_mutants(suite, stream, color);
    const bool sound = !suite->failed && suite->mutants_detected == suite->mutants;
    fprintf(stream, "\n%s%s%s: %zu figures passed, %zu failed, %zu skipped",
            paint(color, sound ? "\033[1;32m" : "\033[1;31m"), sound ? "all well" : "FAILED",
            paint(color, "\033[0m"), suite->passed, suite->failed, suite->skipped);
    if (suite->outcome_count)
        fprintf(stream, "; %zu of %zu mutants caught", suite->mutants_detected, suite->mutants);
    fprintf(stream,
            "; %.1f s\nvalue: the figure nearest to its bound; margin: bound/value; floor: "
            "round-off below which it means nothing\n",
            suite->seconds);
    json_t *headlines = sound ? NULL : headline_list(suite);
    if (headlines) {
        fputc('\n', stream);
        headline_print(headlines, stream, color);
    }
    json_decref(headlines);
}

static json_t *figure_json(const struct figure *figure)
{
    return result_object("group=%s name=%s rank=%d subject=%s property=%s value=%g bound=%g "
                         "floor=%g status=%s seconds=%g",
                         figure->check->group, figure->check->name, figure->check->rank,
                         figure->subject, figure->check->property, figure->value, figure->bound,
                         figure->floor, finding_words[figure->status], figure->seconds);
}

void suite_output_json(const struct suite *suite, json_t *document)
{
    json_t *checks = json_array(), *mutants = json_array();
    for (size_t i = 0; i < suite->figure_count; i++)
        json_array_append_new(checks, figure_json(&suite->figures[i]));
    for (size_t i = 0; i < suite->outcome_count; i++) {
        const struct mutant_outcome *o = &suite->outcomes[i];
        json_array_append_new(
            mutants,
            result_object("group=%s check=%s mutant=%s fault=%s value=%g bound=%g detected=%d?",
                          o->check->group, o->check->name, o->mutant->name, o->mutant->fault,
                          o->value, o->bound, o->detected));
    }
    json_object_set_new(document, "checks", checks);
    json_object_set_new(document, "mutants", mutants);
    json_object_set_new(document, "summary",
                        result_object("passed=%zu failed=%zu skipped=%zu mutants=%zu detected=%zu",
                                      suite->passed, suite->failed, suite->skipped, suite->mutants,
                                      suite->mutants_detected));
}

enum status suite_output_junit(const struct suite *suite, const char *path, struct error *error)
{
    json_t *document = json_object();
    suite_output_json(suite, document);
    char *text = findings_junit(findings_of_verify, document);
    json_decref(document);
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    const enum status status = output_text(path, text, error);
    free(text);
    return status;
}

json_t *suite_output_series(const struct suite *suite, const struct check *check)
{
    json_t *list = json_array();
    for (size_t i = 0; i < suite->series_count; i++) {
        const struct series *s = &suite->series[i];
        if (!check || s->check == check)
            json_array_append_new(list, result_object("label=%s x=%p y=%p", s->label,
                                                      (void *)result_numbers(s->x, s->n),
                                                      (void *)result_numbers(s->y, s->n)));
    }
    return list;
}

static json_t *failure_json(const struct suite *suite, const struct tally *t)
{
    json_t *document = result_new("verify"), *checks = json_array();
    for (size_t i = t->begin; i < t->end; i++)
        json_array_append_new(checks, figure_json(&suite->figures[i]));
    json_object_set_new(document, "checks", checks);
    json_object_set_new(document, "series", suite_output_series(suite, t->check));
    return document;
}

/* The series that the check added to its figures; 0 curves: none. */
static size_t curves_of(const struct suite *suite, const struct check *check,
                        struct plot_series curves[SERIES_SHOWN])
{
    size_t n = 0;
    for (size_t i = 0; i < suite->series_count && n < SERIES_SHOWN; i++) {
        const struct series *s = &suite->series[i];
        if (s->check == check)
            curves[n++] = (struct plot_series){
                .label = s->label, .kind = PLOT_LINES, .n = s->n, .x = s->x, .y = s->y};
    }
    return n;
}

/* Every figure of the check over its bound, in measuring order; failing ones exceed 1. x, low,
 * high: space for all of them. */
static size_t figures_of(const struct suite *suite, const struct tally *t,
                         struct plot_series curves[SERIES_SHOWN], double *x, double *low,
                         double *high)
{
    const double least = 1e-6, most = 1e12;
    const size_t n = t->end - t->begin;
    for (size_t i = 0; i < n; i++) {
        const struct figure *figure = &suite->figures[t->begin + i];
        const double ratio = finding_ratio(figure->value, figure->bound);
        const double shown = fmin(fmax(ratio, least), most);
        x[i] = (double)i + 1;
        low[i] = figure->status == FINDING_PASS ? shown : (double)NAN;
        high[i] = figure->status == FINDING_FAIL ? shown : (double)NAN;
    }
    curves[0] =
        (struct plot_series){.label = "pass", .kind = PLOT_POINTS, .n = n, .x = x, .y = low};
    curves[1] =
        (struct plot_series){.label = "fail", .kind = PLOT_POINTS, .n = n, .x = x, .y = high};
    return 2;
}

/* Plots the check's data, and its figures over their bounds. True if plotted. */
static bool plot_failure(const struct suite *suite, const struct tally *t, const char *path)
{
    const size_t n = t->end - t->begin;
    struct plot_series data[SERIES_SHOWN], figures[SERIES_SHOWN];
    double *values = calloc(3 * n, sizeof *values);
    if (!values) return false;
    const size_t curves = curves_of(suite, t->check, data);
    const struct plot_mark bound = {.at = 1, .horizontal = true, .label = "bound"};
    const struct plot_panel panels[] = {
        {.x_label = "x",
         .y_label = t->check->name,
         .series = data,
         .series_count = curves,
         .own_x = true},
        {.x_label = "figure",
         .y_label = "value / bound",
         .y_log = true,
         .series = figures,
         .series_count = figures_of(suite, t, figures, values, values + n, values + 2 * n),
         .marks = &bound,
         .mark_count = 1,
         .own_x = true}};
    const struct plot plot = {.name = t->check->name,
                              .title = t->check->property,
                              .show_title = true,
                              .panels = curves ? panels : panels + 1,
                              .panel_count = curves ? 2 : 1};
    const bool drawn = picture_write(&plot, path, NULL) == STATUS_OK;
    free(values);
    return drawn;
}

enum status suite_output_failures(const struct suite *suite, const char *folder, FILE *stream,
                                  struct error *error)
{
    enum status status = STATUS_OK;
    for (size_t i = 0; i < suite->figure_count && !status;) {
        const struct tally t = tally_next(suite, i);
        char data[PATH_LENGTH], plot[PATH_LENGTH];
        i = t.end;
        snprintf(data, sizeof data, "%s/%s-%s.json", folder, t.check->group, t.check->name);
        snprintf(plot, sizeof plot, "%s/%s-%s.svg", folder, t.check->group, t.check->name);
        unlink(data); /* of an earlier fault */
        unlink(plot);
        if (!t.failed) continue;
        if (mkdir(folder, 0777) && errno != EEXIST)
            return error_set(error, STATUS_ENVIRONMENT, "verify: cannot make the folder '%s': %s",
                             folder, strerror(errno));
        json_t *document = failure_json(suite, &t);
        status = result_write(document, data, error);
        json_decref(document);
        if (stream && !status) fprintf(stream, "figures and data: %s\n", data);
        if (!status && plot_failure(suite, &t, plot) && stream)
            fprintf(stream, "plot:             %s\n", plot);
    }
    if (!suite->failed) rmdir(folder); /* succeeds only if the folder is empty */
    return status;
}
