/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cases: profiles over the exact solution, residuals, convergence, tables. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"

enum { SCHEMES = PLOT_COLORS, LEVELS = 64, QUANTITIES = 3 };

static const char *const quantities[QUANTITIES] = {"density", "velocity", "pressure"};

/* Numbers of an array, malloced; *n is raised to its size if larger. NULL: no memory or no array.
 */
static double *numbers(const json_t *array, size_t *n)
{
    size_t size = json_array_size(array);
    double *values = size ? malloc(size * sizeof *values) : NULL;
    for (size_t i = 0; values && i < size; i++) values[i] = html_real(json_array_get(array, i));
    *n = values ? size : 0;
    return values;
}

/* What the plots of one case are drawn from; owned arrays. */
struct curves {
    size_t runs;
    const char *label[SCHEMES];
    size_t n[SCHEMES], exact_n;
    double *x[SCHEMES], *value[SCHEMES][QUANTITIES], *residual[SCHEMES][QUANTITIES];
    double *exact_x, *exact[QUANTITIES];
};

static void add_curve(struct curves *curves, const json_t *run)
{
    const json_t *profile = json_object_get(run, "profile");
    size_t k = curves->runs, n = 0, length;
    if (!profile || k == SCHEMES) return;
    curves->label[k] = html_string(run, "label");
    curves->x[k] = numbers(json_object_get(profile, "x"), &n);
    curves->n[k] = n;
    for (int q = 0; q < QUANTITIES; q++) {
        char name[64];
        snprintf(name, sizeof name, "exact_%s", quantities[q]);
        double *value = numbers(json_object_get(profile, quantities[q]), &length);
        double *residual = numbers(json_object_get(profile, name), &n);
        curves->value[k][q] = value;
        curves->residual[k][q] = residual;
        if (length < curves->n[k]) curves->n[k] = length;
        if (n < curves->n[k]) curves->n[k] = n;
        for (size_t i = 0; value && residual && i < n && i < length; i++)
            residual[i] = value[i] - residual[i];
    }
    curves->runs++;
    const json_t *exact = json_object_get(profile, "exact");
    if (curves->exact_x || !exact) return;
    curves->exact_x = numbers(json_object_get(exact, "x"), &curves->exact_n);
    for (int q = 0; q < QUANTITIES; q++) {
        curves->exact[q] = numbers(json_object_get(exact, quantities[q]), &n);
        if (n < curves->exact_n) curves->exact_n = n;
    }
}

static void free_curves(struct curves *curves)
{
    for (size_t k = 0; k < curves->runs; k++) {
        free(curves->x[k]);
        for (int q = 0; q < QUANTITIES; q++) {
            free(curves->value[k][q]);
            free(curves->residual[k][q]);
        }
    }
    free(curves->exact_x);
    for (int q = 0; q < QUANTITIES; q++) free(curves->exact[q]);
}

static void plot_name(char *name, size_t size, const char *case_name, const char *what)
{
    snprintf(name, size, "%.60s-%s", case_name, what);
    for (char *c = name; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-", *c))
            *c = '_';
    if (*name == '_' || *name == '-' || (*name >= '0' && *name <= '9')) *name = 'c';
}

static void plot_profiles(struct page_writer *writer, const char *case_name,
                          const struct curves *curves)
{
    static const char *const labels[] = {"density", "velocity", "pressure"};
    struct plot_series series[QUANTITIES][SCHEMES + 1];
    struct plot_panel panels[QUANTITIES] = {0};
    for (int q = 0; q < QUANTITIES; q++) {
        size_t n = 0;
        if (curves->exact_x)
            series[q][n++] = (struct plot_series){.label = "exact",
                                                  .kind = PLOT_LINES,
                                                  .n = curves->exact_n,
                                                  .x = curves->exact_x,
                                                  .y = curves->exact[q],
                                                  .color = PLOT_NEUTRAL};
        for (size_t k = 0; k < curves->runs; k++)
            series[q][n++] = (struct plot_series){.label = curves->label[k],
                                                  .kind = PLOT_POINTS,
                                                  .n = curves->n[k],
                                                  .x = curves->x[k],
                                                  .y = curves->value[k][q],
                                                  .color = (int)k + 1,
                                                  .size = 0.5};
        panels[q] = (struct plot_panel){.x_label = "position x",
                                        .y_label = labels[q],
                                        .key = q ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[q],
                                        .series_count = n};
    }
    char name[96];
    plot_name(name, sizeof name, case_name, "profiles");
    const struct plot plot = {.name = name,
                              .title = "Profiles of density, velocity and pressure",
                              .panels = panels,
                              .panel_count = QUANTITIES};
    page_plot(writer, &plot, "Each point is a particle; the line is the exact solution.");
}

static void plot_residuals(struct page_writer *writer, const char *case_name,
                           const struct curves *curves)
{
    static const char *const labels[] = {"Δ density", "Δ velocity", "Δ pressure"};
    static const struct plot_mark zero = {0, true, NULL};
    struct plot_series series[QUANTITIES][SCHEMES];
    struct plot_panel panels[QUANTITIES] = {0};
    for (int q = 0; q < QUANTITIES; q++) {
        for (size_t k = 0; k < curves->runs; k++)
            series[q][k] = (struct plot_series){.label = curves->label[k],
                                                .kind = PLOT_LINES,
                                                .n = curves->n[k],
                                                .x = curves->x[k],
                                                .y = curves->residual[k][q],
                                                .color = (int)k + 1};
        panels[q] = (struct plot_panel){.x_label = "position x",
                                        .y_label = labels[q],
                                        .key = q ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[q],
                                        .series_count = curves->runs,
                                        .marks = &zero,
                                        .mark_count = 1};
    }
    char name[96];
    plot_name(name, sizeof name, case_name, "residuals");
    const struct plot plot = {.name = name,
                              .title = "Residuals: particle minus exact solution",
                              .panels = panels,
                              .panel_count = QUANTITIES};
    page_plot(writer, &plot, "The same particles minus the exact solution.");
}

/* ---- convergence ---- */

struct study {
    const json_t *document;
    size_t levels;
    double n[LEVELS], error[LEVELS], fit[LEVELS];
    double order;
};

static const json_t *order_of(const json_t *study, const char *field, const char *norm)
{
    size_t i;
    const json_t *order;
    json_array_foreach(json_object_get(study, "orders"), i, order)
    {
        if (!strcmp(html_string(order, "field"), field) &&
            !strcmp(html_string(order, "norm"), norm))
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
        double n = html_member(level, "n");
        double error = html_member2(json_object_get(level, "errors"), "density", "l1");
        study->n[study->levels] = n;
        study->error[study->levels++] = error;
        sum_n += log(n);
        sum_error += log(error);
    }
    study->order = html_member(order_of(document, "density", "l1"), "order");
    double count = (double)study->levels;
    for (i = 0; i < study->levels; i++)
        study->fit[i] = exp(sum_error / count - study->order * (log(study->n[i]) - sum_n / count));
}

static void plot_convergence(struct page_writer *writer, const char *case_name,
                             const struct study *studies, size_t count)
{
    struct plot_series series[2 * SCHEMES];
    size_t used = 0, widest = 0;
    double lowest = (double)INFINITY, slopes_at = (double)INFINITY;
    for (size_t k = 0; k < count; k++) {
        const struct study *study = &studies[k];
        series[used++] = (struct plot_series){.label = html_string(study->document, "label"),
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
    plot_name(name, sizeof name, case_name, "convergence");
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
        buffer_escape(&columns, html_string(studies[k].document, "label"));
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
    html_table_end(to);
}

static void gate_words(struct buffer *to, const json_t *gate)
{
    buffer_add(to, "<td>");
    if (json_is_object(gate)) {
        html_number(to, html_member(gate, "low"));
        buffer_add(to, " to ");
        html_number(to, html_member(gate, "high"));
        double bound = html_member(gate, "bound");
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
        const char *status = html_string(order, "status");
        bool gated = json_is_object(json_object_get(order, "gate"));
        bool shown = !strcmp(html_string(order, "norm"), "l1");
        if (!gated && !shown && strcmp(status, "fail")) continue;
        buffer_add(to, "<tr>");
        html_cell(to, html_string(study->document, "label"));
        buffer_format(to, "<td>%s of ", norm_name(html_string(order, "norm")));
        html_words(to, html_string(order, "field"));
        buffer_add(to, "</td><td class=\"n\">");
        buffer_format(to, "%.2f", html_member(order, "order"));
        buffer_format(to, "</td><td class=\"n\">%.2f to %.2f</td><td>", html_member(order, "low"),
                      html_member(order, "high"));
        json_array_foreach(json_object_get(order, "pairwise"), j, pair)
            buffer_format(to, "%s%.2f", j ? ", " : "", html_real(pair));
        buffer_add(to, "</td>");
        gate_words(to, json_object_get(order, "gate"));
        buffer_add(to, "<td>");
        if (gated) html_status(to, status);
        buffer_add(to, "</td></tr>\n");
    }
}

static void order_table(struct buffer *to, const struct study *studies, size_t count)
{
    buffer_add(to, "<details open=\"open\"><summary><b>Orders of convergence</b></summary>\n");
    html_table(to, "orders", "scheme|error|#order|#95 % interval|pairwise|expected|");
    for (size_t k = 0; k < count; k++) order_rows(to, &studies[k]);
    html_table_end(to);
    buffer_add(to, "</details>\n");
}

static void run_table(struct buffer *to, const json_t *const *runs, size_t count)
{
    html_table(to, "runs",
               "scheme|#n|#L1 density|#L1 velocity|#L1 pressure|#mass|#momentum|#energy|#steps|"
               "#CPU s|");
    for (size_t k = 0; k < count; k++) {
        const json_t *errors = json_object_get(runs[k], "errors");
        buffer_add(to, "<tr>");
        html_cell(to, html_string(runs[k], "label"));
        html_cell_number(to, html_member(runs[k], "n"));
        for (int q = 0; q < QUANTITIES; q++)
            html_cell_number(to, html_member2(errors, quantities[q], "l1"));
        html_cell_number(to, html_member2(runs[k], "conservation", "mass"));
        html_cell_number(to, html_member2(runs[k], "conservation", "momentum"));
        html_cell_number(to, html_member2(runs[k], "conservation", "energy"));
        html_cell_number(to, html_member2(runs[k], "cost", "steps"));
        html_cell_number(to, html_member2(runs[k], "cost", "cpu_s"));
        buffer_add(to, "<td>");
        html_status(to, html_string(runs[k], "status"));
        buffer_add(to, "</td></tr>\n");
    }
    html_table_end(to);
}

/* One case: everything that the results have on it. */
static void one_case(struct page_writer *writer, const json_t *results, const char *name)
{
    struct buffer *to = &writer->to;
    const json_t *runs[SCHEMES], *entry, *title = NULL;
    struct study *studies = calloc(SCHEMES, sizeof *studies);
    struct curves curves = {0};
    size_t i, run_count = 0, study_count = 0;
    if (!studies) {
        to->failed = true;
        return;
    }
    json_array_foreach(json_object_get(results, "runs"), i, entry)
    {
        if (strcmp(html_string(entry, "case"), name) || run_count == SCHEMES) continue;
        runs[run_count++] = entry;
        add_curve(&curves, entry);
        if (!title) title = json_object_get(entry, "title");
    }
    json_array_foreach(json_object_get(results, "studies"), i, entry)
    {
        if (strcmp(html_string(entry, "case"), name) || study_count == SCHEMES) continue;
        read_study(&studies[study_count++], entry);
    }
    buffer_format(to, "<h3 id=\"case-%s\"><code>", name);
    buffer_escape(to, name);
    buffer_add(to, "</code> <span>");
    buffer_escape(to, title ? json_string_value(title) : "");
    buffer_add(to, "</span></h3>\n<div class=\"figures\">\n");
    if (curves.runs) plot_profiles(writer, name, &curves);
    if (curves.runs) plot_residuals(writer, name, &curves);
    if (study_count) {
        plot_convergence(writer, name, studies, study_count);
        buffer_add(to, "<div>");
        error_table(to, studies, study_count);
        buffer_add(to, "</div>");
    }
    buffer_add(to, "</div>\n");
    if (study_count) order_table(to, studies, study_count);
    if (run_count) {
        buffer_add(to, "<h4>Errors, conservation and cost of the runs above</h4>\n");
        run_table(to, runs, run_count);
    }
    for (i = 0; i < run_count; i++)
        html_command(to, html_string(runs[i], "label"), html_string(runs[i], "reproduce"));
    for (i = 0; i < study_count; i++)
        html_command(to, "convergence", html_string(studies[i].document, "reproduce"));
    free_curves(&curves);
    free(studies);
}

static bool seen_before(const json_t *list, size_t before, const char *name)
{
    for (size_t i = 0; i < before; i++)
        if (!strcmp(html_string(json_array_get(list, i), "case"), name)) return true;
    return false;
}

void page_cases(struct page_writer *writer, const json_t *results)
{
    const json_t *runs = json_object_get(results, "runs"), *entry;
    const json_t *studies = json_object_get(results, "studies");
    if (!json_array_size(runs) && !json_array_size(studies)) return;
    buffer_add(&writer->to, "<section id=\"cases\"><h2>Cases against their exact solutions</h2>\n");
    size_t i;
    json_array_foreach(runs, i, entry)
    {
        const char *name = html_string(entry, "case");
        if (!seen_before(runs, i, name)) one_case(writer, results, name);
    }
    json_array_foreach(studies, i, entry)
    {
        const char *name = html_string(entry, "case");
        if (!seen_before(studies, i, name) && !seen_before(runs, json_array_size(runs), name))
            one_case(writer, results, name);
    }
    buffer_add(&writer->to, "</section>\n");
}
