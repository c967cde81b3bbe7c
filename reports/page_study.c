/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_budget.h"
#include "value.h"

enum { LEVELS = 64 };

struct study {
    const json_t *document;
    size_t levels;
    double n[LEVELS], error[LEVELS], fit[LEVELS];
    double order;
};

const json_t *page_study_order(const json_t *study, const char *field, const char *norm)
{
    size_t i;
    const json_t *order;
    json_array_foreach(json_object_get(study, "orders"), i, order)
    {
        if (!strcmp(value_text(order, "field"), field) && !strcmp(value_text(order, "norm"), norm))
            return order;
    }
    return NULL;
}

static void read_study(struct study *study, const json_t *document)
{
    size_t i;
    const json_t *level;
    *study = (struct study){.document = document};
    double sum_n = 0, sum_error = 0;
    json_array_foreach(json_object_get(document, "levels"), i, level)
    {
        if (study->levels == LEVELS) break;
        double n = value_member(level, "n");
        double error = value_inner(json_object_get(level, "errors"), "density", "l1");
        study->n[study->levels] = n;
        study->error[study->levels++] = error;
        sum_n += log(n);
        sum_error += log(error);
    }
    study->order = value_member(page_study_order(document, "density", "l1"), "order");
    double count = (double)study->levels;
    for (i = 0; i < study->levels; i++)
        study->fit[i] = exp(sum_error / count - study->order * (log(study->n[i]) - sum_n / count));
}

static void plot_convergence(struct page_writer *writer, const char *case_name,
                             const struct study *studies, size_t count)
{
    struct plot_series series[2 * PAGE_SCHEMES];
    size_t used = 0, widest = 0;
    double lowest = (double)INFINITY, slopes_at = (double)INFINITY;
    for (size_t k = 0; k < count; k++) {
        const struct study *study = &studies[k];
        series[used++] = (struct plot_series){.label = value_text(study->document, "label"),
                                              .kind = PLOT_POINTS,
                                              .n = study->levels,
                                              .x = study->n,
                                              .y = study->error,
                                              .color = (int)k + 1};
        series[used++] = (struct plot_series){.kind = PLOT_LINES,
                                              .n = study->levels,
                                              .x = study->n,
                                              .y = study->fit,
                                              .color = (int)k + 1};
        if (study->levels > studies[widest].levels) widest = k;
        if (study->levels && study->error[0] < slopes_at) slopes_at = study->error[0];
        for (size_t i = 0; i < study->levels; i++) lowest = fmin(lowest, study->error[i]);
    }
    const struct study *ladder = &studies[widest];
    if (!ladder->levels || !isfinite(slopes_at)) return;
    double first = ladder->n[0], last = ladder->n[ladder->levels - 1];
    /* Reference slopes start below the curves; the second only where it does not squash them. */
    struct plot_slope slopes[2] = {{first, last, 0.7 * slopes_at, -1, "order 1"},
                                   {first, last, 0.7 * slopes_at, -2, "order 2"}};
    size_t slope_count = slopes_at * pow(last / first, -1.5) > lowest ? 2 : 1;
    const struct plot_panel panel = {.x_label = "number of particles n",
                                     .y_label = "L1 error of density",
                                     .x_log = true,
                                     .y_log = true,
                                     .x_ticks = ladder->n,
                                     .x_tick_count = ladder->levels,
                                     .key = PLOT_KEY_END,
                                     .series = series,
                                     .series_count = used,
                                     .slopes = slopes,
                                     .slope_count = slope_count};
    char name[96];
    page_plot_name(name, sizeof name, case_name, "convergence");
    const struct plot plot = {.name = name,
                              .title = "Convergence of the density error",
                              .panels = &panel,
                              .panel_count = 1};
    page_plot(writer, &plot,
              "Points are measured, lines are least-squares fits, dashes have the named order.");
}

static void error_table(struct buffer *to, const struct study *studies, size_t count)
{
    struct buffer columns = {0};
    buffer_add(&columns, "#n");
    for (size_t k = 0; k < count; k++) {
        buffer_add(&columns, "|#");
        buffer_escape(&columns, value_text(studies[k].document, "label"));
    }
    buffer_add(to, "<h4>L1 error of density over n</h4>\n");
    if (columns.data) html_table(to, "errors", columns.data);
    buffer_free(&columns);
    const struct study *longest = studies;
    for (size_t k = 1; k < count; k++)
        if (studies[k].levels > longest->levels) longest = &studies[k];
    for (size_t i = 0; i < longest->levels; i++) {
        buffer_format(to, "<tr><td class=\"n\">%.0f</td>", longest->n[i]);
        for (size_t k = 0; k < count; k++)
            html_cell_number(to, i < studies[k].levels ? studies[k].error[i] : (double)NAN);
        buffer_add(to, "</tr>\n");
    }
    buffer_add(to, "<tr class=\"total\"><th>order</th>");
    for (size_t k = 0; k < count; k++) {
        const json_t *order = page_study_order(studies[k].document, "density", "l1");
        buffer_format(to, "<td class=\"n\">%.2f ± %.2f</td>", value_member(order, "order"),
                      (value_member(order, "high") - value_member(order, "low")) / 2);
    }
    buffer_add(to, "</tr>\n");
    html_table_end(to);
}

static void gate_words(struct buffer *to, const json_t *gate)
{
    buffer_add(to, "<td>");
    if (json_is_object(gate)) {
        html_number(to, value_member(gate, "low"));
        buffer_add(to, " to ");
        html_number(to, value_member(gate, "high"));
        double bound = value_member(gate, "bound");
        if (isfinite(bound)) {
            buffer_add(to, ", finest ≤ ");
            html_number(to, bound);
        }
    }
    buffer_add(to, "</td>");
}

static const char *norm_name(const char *norm)
{
    static const char *const names[][2] = {
        {"l1", "L1"}, {"l2", "L2"}, {"linf", "L∞"}, {"particle_mean", "particle mean"}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (!strcmp(norm, names[k][0])) return names[k][1];
    return "error";
}

static void order_rows(struct buffer *to, const struct study *study)
{
    size_t i, j;
    const json_t *order, *pair;
    json_array_foreach(json_object_get(study->document, "orders"), i, order)
    {
        const char *status = value_text(order, "status");
        bool gated = json_is_object(json_object_get(order, "gate"));
        bool shown = !strcmp(value_text(order, "norm"), "l1");
        if (!gated && !shown && strcmp(status, "fail")) continue;
        buffer_add(to, "<tr>");
        html_cell(to, value_text(study->document, "label"));
        buffer_format(to, "<td>%s of ", norm_name(value_text(order, "norm")));
        html_words(to, value_text(order, "field"));
        buffer_add(to, "</td><td class=\"n\">");
        buffer_format(to, "%.2f", value_member(order, "order"));
        buffer_format(to, "</td><td class=\"n\">%.2f to %.2f</td><td>", value_member(order, "low"),
                      value_member(order, "high"));
        json_array_foreach(json_object_get(order, "pairwise"), j, pair)
            buffer_format(to, "%s%.2f", j ? ", " : "", value_real(pair));
        buffer_add(to, "</td>");
        gate_words(to, json_object_get(order, "gate"));
        buffer_add(to, "<td>");
        if (gated) html_status(to, status);
        buffer_add(to, "</td></tr>\n");
    }
}

static void order_table(struct buffer *to, const struct study *studies, size_t count)
{
    bool failed = false;
    for (size_t k = 0; k < count; k++) {
        size_t i;
        const json_t *order;
        json_array_foreach(json_object_get(studies[k].document, "orders"), i, order) failed =
            failed || !strcmp(value_text(order, "status"), "fail");
    }
    buffer_format(to,
                  "<details%s><summary>Orders of all quantities, and what is expected</summary>\n",
                  failed ? " open=\"open\"" : "");
    html_table(to, "orders", "scheme|error|#order|#95 % interval|pairwise|expected|");
    for (size_t k = 0; k < count; k++) order_rows(to, &studies[k]);
    html_table_end(to);
    buffer_add(to, "</details>\n");
}

static void percent_cell(struct buffer *to, double part)
{
    buffer_add(to, "<td class=\"n\">");
    if (isfinite(part)) html_number(to, 100 * part);
    buffer_add(to, isfinite(part) ? " %</td>" : "—</td>");
}

/* Scalars of the final state: what they tend to, and how sure that is. */
static void functional_table(struct buffer *to, const struct study *studies, size_t count)
{
    size_t k, i, all = 0;
    const json_t *entry;
    for (k = 0; k < count; k++)
        all += json_array_size(json_object_get(studies[k].document, "functionals"));
    if (!all) return;
    buffer_add(to, "<details><summary>Scalars extrapolated, with their grid convergence index"
                   "</summary>\n");
    html_table(to, "functionals",
               "scheme|scalar|#finest level|#extrapolated|#exact|#order|#GCI, finest|#GCI, "
               "next|convergence");
    for (k = 0; k < count; k++)
        json_array_foreach(json_object_get(studies[k].document, "functionals"), i, entry)
        {
            const json_t *values = json_object_get(entry, "values");
            buffer_add(to, "<tr>");
            html_cell(to, value_text(studies[k].document, "label"));
            buffer_add(to, "<td>");
            html_words(to, value_text(entry, "name"));
            buffer_add(to, "</td>");
            html_cell_digits(to, value_real(json_array_get(values, json_array_size(values) - 1)));
            html_cell_digits(to, value_member(entry, "extrapolated"));
            html_cell_digits(to, value_member(entry, "exact"));
            html_cell_number(to, value_member(entry, "order"));
            percent_cell(to, value_member(entry, "gci"));
            percent_cell(to, value_member(entry, "gci_coarse"));
            html_cell(to, value_text(entry, "class"));
            buffer_add(to, "</tr>\n");
        }
    html_table_end(to);
    buffer_add(to, "<p class=\"note\">Richardson's extrapolation and Roache's grid convergence "
                   "index (GCI: 1.25 times the estimated relative error) of the finest levels; "
                   "only where convergence is asymptotic.</p></details>\n");
}

void page_study(struct page_writer *writer, const char *case_name, const json_t *const *documents,
                size_t count)
{
    struct buffer *to = &writer->to;
    struct study *studies = calloc(count, sizeof *studies);
    if (!studies) {
        to->failed = true;
        return;
    }
    for (size_t k = 0; k < count; k++) read_study(&studies[k], documents[k]);
    buffer_add(to, "<div class=\"figures\">\n");
    plot_convergence(writer, case_name, studies, count);
    buffer_add(to, "<div>");
    error_table(to, studies, count);
    buffer_add(to, "</div></div>\n");
    order_table(to, studies, count);
    functional_table(to, studies, count);
    page_budget(writer, documents, count);
    free(studies);
}
