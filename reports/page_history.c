/* SPDX-License-Identifier: GPL-3.0-or-later
 * Changes since the previous night and over all nights: change points with the revision that
 * changed a figure, and errors and orders of each case against time. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

enum { SHOWN = 16, NIGHTS = 128, MARKS = 6, REVISION = 12 };

static void value(struct buffer *to, const json_t *value)
{
    if (json_is_string(value) && !value_is_real(value))
        buffer_escape(to, json_string_value(value));
    else if (json_is_null(value))
        buffer_add(to, "–");
    else
        html_number(to, value_real(value));
}

static void value_cell(struct buffer *to, const json_t *of)
{
    buffer_add(to, json_is_string(of) || json_is_null(of) ? "<td>" : "<td class=\"n\">");
    value(to, of);
    buffer_add(to, "</td>");
}

static void ratio_cell(struct buffer *to, double ratio)
{
    buffer_add(to, "<td class=\"n\">");
    if (isfinite(ratio) && fabs(ratio - 1) < 0.001)
        buffer_format(to, "%+.1g %%", 100 * (ratio - 1));
    else if (isfinite(ratio) && fabs(ratio - 1) < 1)
        buffer_format(to, "%+.1f %%", 100 * (ratio - 1));
    else if (isfinite(ratio))
        buffer_format(to, "× %.3g", ratio);
    buffer_add(to, "</td>");
}

static void verdict_cell(struct buffer *to, const char *verdict)
{
    buffer_format(to, "<td><b class=\"%s\">%s</b></td>",
                  !strcmp(verdict, "worse")    ? "fail"
                  : !strcmp(verdict, "better") ? "pass"
                                               : "skip",
                  verdict);
}

/* True if one row can represent two entries: of the same subject, verdict and night. */
static bool together(const json_t *a, const json_t *b)
{
    const char *p = value_text(a, "path"), *q = value_text(b, "path");
    const size_t length = strcspn(p, "]"); /* of the name of its run, study or check */
    return length == strcspn(q, "]") && !strncmp(p, q, length) &&
           !strcmp(value_text(a, "verdict"), value_text(b, "verdict")) &&
           !strcmp(value_text(a, "git"), value_text(b, "git")) &&
           !strcmp(value_text(a, "date"), value_text(b, "date"));
}

static double amount(const json_t *entry)
{
    const double change = fabs(log(value_member(entry, "ratio")));
    return isnan(change) ? (double)INFINITY : change;
}

/* The entry with the largest change among those that share a row with list[i]; NULL if a row was
 * already written for them. *others: number of other entries in the row. */
static const json_t *spokesman(const json_t *list, size_t i, size_t *others)
{
    const json_t *most = json_array_get(list, i), *entry = most, *other;
    size_t k;
    *others = 0;
    json_array_foreach(list, k, other) {
        if (!together(entry, other)) continue;
        if (k < i) return NULL;
        *others += k > i;
        if (amount(other) > amount(most)) most = other;
    }
    return most;
}

static void path_cell(struct buffer *to, const char *path, size_t others)
{
    html_format(to, "<td>%s", path);
    if (others) buffer_format(to, "<br/>and %zu more of the same", others);
    buffer_add(to, "</td>");
}

static void since_rows(struct buffer *to, const json_t *figures, const char *verdict, size_t *rows)
{
    const json_t *entry;
    size_t i;
    json_array_foreach(figures, i, entry) {
        size_t others;
        if (*rows == SHOWN) return;
        if (strcmp(value_text(entry, "verdict"), verdict)) continue;
        const json_t *figure = spokesman(figures, i, &others);
        if (!figure) continue;
        ++*rows;
        buffer_add(to, "<tr>");
        verdict_cell(to, verdict);
        path_cell(to, value_text(figure, "path"), others);
        value_cell(to, json_object_get(figure, "old"));
        value_cell(to, json_object_get(figure, "new"));
        ratio_cell(to, value_member(figure, "ratio"));
        buffer_add(to, "</tr>\n");
    }
}

static void since_words(struct buffer *to, const json_t *since)
{
    if (!json_array_size(json_object_get(since, "figures"))) {
        buffer_format(to, "nothing has changed, %.0f figures are the same",
                      value_member(since, "same"));
        return;
    }
    buffer_format(to, "%.0f worse, %.0f better, %.0f the same", value_member(since, "worse"),
                  value_member(since, "better"), value_member(since, "same"));
    if (value_member(since, "incomparable") > 0)
        buffer_format(to, ", %.0f that cannot be compared", value_member(since, "incomparable"));
}

static void revision(struct buffer *to, const char *git)
{
    char text[REVISION + 1];
    snprintf(text, sizeof text, "%.*s", REVISION, git);
    html_format(to, "<code>%s</code>", text);
}

static const json_t *first_worse(const json_t *figures)
{
    size_t i;
    const json_t *figure;
    json_array_foreach(figures, i, figure) {
        if (!strcmp(value_text(figure, "verdict"), "worse")) return figure;
    }
    return NULL;
}

/* Seconds since 1970 of "2026-01-31T12:00:00Z"; NaN: not a date. */
static double seconds_of(const char *date)
{
    struct tm tm = {0};
    if (sscanf(date, "%d-%d-%dT%d:%d:%d", &tm.tm_year, &tm.tm_mon, &tm.tm_mday, &tm.tm_hour,
               &tm.tm_min, &tm.tm_sec) != 6)
        return (double)NAN;
    tm.tm_year -= 1900;
    tm.tm_mon -= 1;
    return (double)timegm(&tm);
}

/* Writes "24 minutes before". */
static void how_long(struct buffer *to, const json_t *since, const json_t *results)
{
    static const struct {
        double seconds;
        const char *name;
    } units[] = {{86400, "day"}, {3600, "hour"}, {60, "minute"}, {1, "second"}};
    const double passed =
        seconds_of(value_text(results, "date")) - seconds_of(value_text(since, "date"));
    size_t u = 0;
    if (!(passed >= 0)) return;
    while (u < 3 && passed < 2 * units[u].seconds) u++;
    const double count = floor(passed / units[u].seconds);
    buffer_format(to, ", %.0f %s%s before", count, units[u].name, count == 1 ? "" : "s");
}

/* The figure that got worse by most, with marks around its values. */
static void add_worst(struct buffer *to, const json_t *since, const char *open, const char *close)
{
    const json_t *worst = first_worse(json_object_get(since, "figures"));
    if (!worst) return;
    html_format(to, "; most: %s", value_text(worst, "path"));
    buffer_add(to, open);
    value(to, json_object_get(worst, "old"));
    buffer_add(to, " → ");
    value(to, json_object_get(worst, "new"));
    buffer_add(to, close);
}

void page_since(struct buffer *to, const json_t *results)
{
    const json_t *since = html_member(results, "history/since");
    if (!json_is_object(since)) return;
    buffer_add(to, "<p class=\"facts\"><a href=\"#history\">Since the last report</a> (git ");
    revision(to, value_text(since, "git"));
    how_long(to, since, results);
    buffer_add(to, "): ");
    since_words(to, since);
    add_worst(to, since, " <b>", "</b>");
    buffer_add(to, "</p>\n");
}

void page_since_plain(struct buffer *to, const json_t *results)
{
    const json_t *since = html_member(results, "history/since");
    if (!json_is_object(since)) return;
    buffer_format(to, "Since the last report (git %.*s): ", REVISION, value_text(since, "git"));
    since_words(to, since);
    add_worst(to, since, " ", "");
    buffer_add(to, ".\n\n");
}

static void since_section(struct buffer *to, const json_t *since)
{
    static const char *const verdicts[] = {"worse", "incomparable", "better"};
    const json_t *figures = json_object_get(since, "figures");
    size_t rows = 0;
    html_format(to, "<h3>Since the last report</h3><p>Against %s, git ", value_text(since, "date"));
    revision(to, value_text(since, "git"));
    buffer_add(to, ": ");
    since_words(to, since);
    buffer_add(to, ".</p>\n");
    if (!json_array_size(figures)) return;
    html_table(to, "since", "|figure|#before|#now|#change");
    for (size_t v = 0; v < 3; v++) since_rows(to, figures, verdicts[v], &rows);
    html_table_end(to);
    if (rows == SHOWN) buffer_add(to, "<p>All of them are in results.json.</p>");
}

static void change_row(struct buffer *to, const json_t *change, size_t others)
{
    char date[11];
    snprintf(date, sizeof date, "%.10s", value_text(change, "date"));
    buffer_add(to, "<tr>");
    verdict_cell(to, value_text(change, "verdict"));
    path_cell(to, value_text(change, "path"), others);
    html_cell_number(to, value_member(change, "before"));
    html_cell_number(to, value_member(change, "after"));
    ratio_cell(to, value_member(change, "ratio"));
    html_cell(to, date);
    buffer_add(to, "<td>");
    revision(to, value_text(change, "git_before"));
    buffer_add(to, " → ");
    revision(to, value_text(change, "git"));
    buffer_add(to, "</td></tr>\n");
}

static void change_table(struct buffer *to, const json_t *changes)
{
    size_t rows = 0, i, others;
    const json_t *entry;
    buffer_add(to, "<h3>Where figures moved</h3>\n");
    if (!json_array_size(changes)) {
        buffer_add(to, "<p>No error and no order by which a case is judged has moved beyond "
                       "its noise over all these nights.</p>\n");
        return;
    }
    html_table(to, "changes", "|figure|#before|#after|#change|first night|revision");
    json_array_foreach(changes, i, entry) {
        const json_t *change = spokesman(changes, i, &others);
        if (rows == SHOWN) break;
        if (!change) continue;
        change_row(to, change, others);
        rows++;
    }
    html_table_end(to);
    if (rows == SHOWN) buffer_add(to, "<p>All of them are in results.json.</p>");
}

struct curves {
    size_t count, nights;
    const char *field, *label[PAGE_SCHEMES];
    double night[NIGHTS], error[PAGE_SCHEMES][NIGHTS], order[PAGE_SCHEMES][NIGHTS];
    struct plot_mark marks[MARKS];
    size_t mark_count;
    char mark_names[MARKS][REVISION + 1];
};

static void read_curve(struct curves *curves, const json_t *trend)
{
    const json_t *error = json_object_get(trend, "error"), *order = json_object_get(trend, "order");
    const size_t k = curves->count++;
    curves->label[k] = value_text(trend, "label");
    if (k == 0) curves->field = value_text(trend, "field");
    for (size_t i = 0; i < curves->nights; i++) {
        curves->error[k][i] = value_real(json_array_get(error, i));
        curves->order[k][i] = value_real(json_array_get(order, i));
    }
}

/* Reads the nights on which some figure of the case changed, each once. */
static void read_marks(struct curves *curves, const json_t *changes, const char *case_name)
{
    size_t i, length = strlen(case_name);
    const json_t *change;
    json_array_foreach(changes, i, change) {
        const char *path = value_text(change, "path");
        const double night = value_member(change, "night") + 1;
        bool known = curves->mark_count == MARKS;
        for (size_t m = 0; m < MARKS; m++) /* one that is free stands at 0, before the first night */
            known = known || curves->marks[m].at == night;
        if (known || strncmp(path, "studies[", 8) || strncmp(path + 8, case_name, length) ||
            path[8 + length] != ',')
            continue;
        char *name = curves->mark_names[curves->mark_count];
        snprintf(name, sizeof *curves->mark_names, "%.7s", value_text(change, "git"));
        curves->marks[curves->mark_count++] = (struct plot_mark){.at = night, .label = name};
    }
}

static void plot_trend(struct page_writer *writer, const char *case_name, struct curves *curves)
{
    struct plot_series series[2][PAGE_SCHEMES];
    char name[96], title[128], caption[256], error[64];
    snprintf(error, sizeof error, "L1 of %.40s", curves->field);
    for (size_t k = 0; k < curves->count; k++)
        for (int panel = 0; panel < 2; panel++)
            series[panel][k] =
                (struct plot_series){.label = curves->label[k],
                                     .kind = PLOT_LINES_POINTS,
                                     .n = curves->nights,
                                     .x = curves->night,
                                     .y = panel ? curves->order[k] : curves->error[k],
                                     .color = (int)k + 1,
                                     .size = 0.6};
    const struct plot_panel panels[2] = {{.x_label = "night",
                                          .y_label = error,
                                          .y_log = true,
                                          .key = PLOT_KEY_TOP,
                                          .series = series[0],
                                          .series_count = curves->count,
                                          .marks = curves->marks,
                                          .mark_count = curves->mark_count},
                                         {.x_label = "night",
                                          .y_label = "order",
                                          .key = PLOT_KEY_NONE,
                                          .series = series[1],
                                          .series_count = curves->count}};
    page_plot_name(name, sizeof name, case_name, "trend");
    snprintf(title, sizeof title, "Error and order of %.80s over the nights", case_name);
    const struct plot plot = {.name = name, .title = title, .panels = panels, .panel_count = 2};
    snprintf(caption, sizeof caption,
             "%.80s: finest level's error and the order; the last night is this one, lines stand "
             "where something moved.",
             case_name);
    page_plot(writer, &plot, caption);
}

static void plot_trends(struct page_writer *writer, const json_t *history, size_t nights)
{
    const json_t *trends = json_object_get(history, "trends"), *trend;
    struct curves *curves = page_allocate(&writer->to, 1, sizeof *curves);
    const char *name = "";
    size_t i;
    if (!curves) return;
    buffer_add(&writer->to, "<div class=\"figures\">\n");
    json_array_foreach(trends, i, trend) {
        const char *own = value_text(trend, "case");
        if (strcmp(own, name)) {
            if (curves->count) plot_trend(writer, name, curves);
            *curves = (struct curves){.nights = nights};
            for (size_t k = 0; k < nights; k++) curves->night[k] = (double)k + 1;
            read_marks(curves, json_object_get(history, "changes"), own);
            name = own;
        }
        const bool same = !curves->count || strcmp(curves->field, value_text(trend, "field")) == 0;
        if (same && curves->count < PAGE_SCHEMES) read_curve(curves, trend);
    }
    if (curves->count) plot_trend(writer, name, curves);
    buffer_add(&writer->to, "</div>\n");
    free(curves);
}

void page_history(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *history = json_object_get(results, "history");
    size_t nights = json_array_size(json_object_get(history, "nights"));
    if (nights > NIGHTS) nights = NIGHTS;
    buffer_add(to, "<section id=\"history\"><h2>What changed</h2>\n");
    since_section(to, json_object_get(history, "since"));
    if (nights >= 3) {
        change_table(to, json_object_get(history, "changes"));
        plot_trends(writer, history, nights);
    }
    if (value_member(history, "unreadable") > 0)
        buffer_format(to, "<p>%.0f lines of the history could not be read.</p>",
                      value_member(history, "unreadable"));
    buffer_add(to, "</section>\n");
}
