/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_state.h"
#include "html.h"
#include "value.h"

enum { LEVELS = 64, PLOTTED = 3 };

/* Errors of one quantity (L1 of a field, or the distance of a scalar from its exact value):
 * measured, least-squares fit, and the range of the 95 % interval of the order, about the middle of
 * the ladder. */
struct fitted {
    double error[LEVELS], fit[LEVELS], low[LEVELS], high[LEVELS];
};

struct study {
    const json_t *document;
    size_t levels;
    int dimension, plotted;
    const char *names[PLOTTED];
    double n[LEVELS];
    struct fitted of[PLOTTED];
};

const json_t *page_study_order(const json_t *study, const char *field, const char *norm)
{
    size_t i;
    const json_t *order;
    json_array_foreach(json_object_get(study, "orders"), i, order) {
        if (!strcmp(value_text(order, "field"), field) && !strcmp(value_text(order, "norm"), norm))
            return order;
    }
    return NULL;
}

/* The order of a field in the norm that pages show, or that of a scalar's error. */
static const json_t *order_of(const json_t *document, const char *name)
{
    const json_t *order = page_study_order(document, name, "l1");
    return order ? order : page_study_order(document, name, "error");
}

/* Reads the names of the errors by which the case is judged, at most PLOTTED; returns their
 * number. */
static int read_names(const json_t *document, const char *names[PLOTTED])
{
    static const char *const usual[PLOTTED] = {"density", "velocity", "pressure"};
    const json_t *measured = json_object_get(document, "measured"), *name;
    int n = 0;
    size_t i;
    json_array_foreach(measured, i, name)
        if (n < PLOTTED && json_is_string(name)) names[n++] = json_string_value(name);
    for (int q = 0; q < PLOTTED && !measured; q++) names[n++] = usual[q];
    return n;
}

const json_t *page_study_main(const json_t *document)
{
    const char *names[PLOTTED];
    return read_names(document, names) ? order_of(document, names[0]) : NULL;
}

static bool is_scalar(const json_t *order)
{
    return !strcmp(value_text(order, "norm"), "error");
}

void page_study_name(struct buffer *to, const json_t *order)
{
    html_format(to, is_scalar(order) ? "the error of %-s" : "L1(%-s)", value_text(order, "field"));
}

double page_study_finest(const json_t *document)
{
    const char *names[PLOTTED];
    const size_t levels = json_array_size(json_object_get(document, "levels"));
    return levels && read_names(document, names)
               ? case_state_level_error(document, names[0], levels - 1)
               : (double)NAN;
}

static void fit(struct study *study, int quantity)
{
    struct fitted *of = &study->of[quantity];
    const json_t *order = order_of(study->document, study->names[quantity]);
    const double count = (double)study->levels, dim = study->dimension;
    const double slope = value_member(order, "order") / dim;
    const double half = (value_member(order, "high") - value_member(order, "low")) / 2 / dim;
    double sum_n = 0, sum_error = 0;
    for (size_t i = 0; i < study->levels; i++) {
        sum_n += log(study->n[i]);
        sum_error += log(of->error[i]);
    }
    for (size_t i = 0; i < study->levels; i++) {
        const double from_middle = log(study->n[i]) - sum_n / count;
        of->fit[i] = exp(sum_error / count - slope * from_middle);
        of->low[i] = of->fit[i] * exp(-half * fabs(from_middle));
        of->high[i] = of->fit[i] * exp(half * fabs(from_middle));
    }
}

static void read_study(struct study *study, const json_t *document)
{
    size_t i;
    const json_t *level;
    const double dimension = value_member(document, "dimension");
    *study = (struct study){.document = document};
    study->dimension = isfinite(dimension) ? (int)dimension : 1;
    study->plotted = read_names(document, study->names);
    json_array_foreach(json_object_get(document, "levels"), i, level) {
        if (study->levels == LEVELS) break;
        for (int q = 0; q < study->plotted; q++)
            study->of[q].error[study->levels] =
                case_state_level_error(document, study->names[q], i);
        study->n[study->levels++] = value_member(level, "n");
    }
    for (int q = 0; q < study->plotted; q++) fit(study, q);
}

/* Adds the series of one panel: bands first, so that they are below. */
static size_t add_series(struct plot_series *series, const struct study *studies, size_t count,
                         int quantity)
{
    size_t used = 0;
    for (int round = 0; round < 2; round++)
        for (size_t k = 0; k < count; k++) {
            const struct study *study = &studies[k];
            const struct fitted *of = &study->of[quantity];
            struct plot_series one = {
                .n = study->levels, .x = study->n, .color = (int)k + 1, .y = of->error};
            if (round == 0) {
                one.kind = PLOT_BAND;
                one.low = of->low;
                one.high = of->high;
                series[used++] = one;
                continue;
            }
            one.kind = PLOT_POINTS;
            one.label = value_text(study->document, "label");
            series[used++] = one;
            one.kind = PLOT_LINES;
            one.label = NULL;
            one.y = of->fit;
            series[used++] = one;
        }
    return used;
}

/* Adds reference slopes below the curves; the second only if it does not squeeze the curves. */
static size_t add_slopes(struct plot_slope slopes[2], const struct study *studies, size_t count,
                         const struct study *ladder, int quantity)
{
    double lowest = (double)INFINITY, at = (double)INFINITY;
    for (size_t k = 0; k < count; k++) {
        const struct study *study = &studies[k];
        if (study->levels) at = fmin(at, study->of[quantity].error[0]);
        for (size_t i = 0; i < study->levels; i++)
            lowest = fmin(lowest, study->of[quantity].error[i]);
    }
    const double dim = ladder->dimension, first = ladder->n[0],
                 last = ladder->n[ladder->levels - 1];
    if (!isfinite(at) || !(at > 0)) return 0;
    slopes[0] = (struct plot_slope){first, last, 0.7 * at, -1 / dim, "order 1"};
    slopes[1] = (struct plot_slope){first, last, 0.7 * at, -2 / dim, "order 2"};
    return at * pow(last / first, -1.5 / dim) > lowest ? 2 : 1;
}

static void plot_convergence(struct page_writer *writer, const char *case_name,
                             const struct study *studies, size_t count)
{
    struct plot_series series[PLOTTED][3 * PAGE_SCHEMES];
    struct plot_slope slopes[PLOTTED][2];
    struct plot_panel panels[PLOTTED];
    char labels[PLOTTED][64], name[96];
    const struct study *ladder = studies;
    for (const struct study *study = studies; study < studies + count; study++)
        if (study->levels > ladder->levels) ladder = study;
    if (!ladder->levels || !ladder->plotted) return;
    for (int q = 0; q < ladder->plotted; q++) {
        const bool scalar = is_scalar(order_of(ladder->document, ladder->names[q]));
        snprintf(labels[q], sizeof labels[q], "%s of %s", scalar ? "error" : "L1",
                 ladder->names[q]);
        for (char *c = labels[q]; *c; c++)
            if (*c == '_') *c = ' ';
        panels[q] = (struct plot_panel){.x_label = "number of particles n",
                                        .y_label = labels[q],
                                        .x_log = true,
                                        .y_log = true,
                                        .x_ticks = ladder->n,
                                        .x_tick_count = ladder->levels,
                                        .key = q ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[q],
                                        .slopes = slopes[q]};
        panels[q].series_count = add_series(series[q], studies, count, q);
        panels[q].slope_count = add_slopes(slopes[q], studies, count, ladder, q);
    }
    page_plot_name(name, sizeof name, case_name, "convergence");
    const struct plot plot = {.name = name,
                              .title = "Convergence of the errors",
                              .panels = panels,
                              .panel_count = (size_t)ladder->plotted};
    page_plot(writer, &plot,
              "Points are measured, lines are least-squares fits; the shade is the 95 % interval "
              "of the order, dashes have the named order.");
}

/* Writes the main error at a number of particles, with the standard deviation of its replicates if
 * above 3 %; a dash if the study has no such level. */
static void error_cell(struct buffer *to, const struct study *study, double n)
{
    size_t i = 0;
    while (i < study->levels && study->n[i] != n) i++;
    if (i == study->levels) {
        buffer_add(to, "<td class=\"n\">—</td>");
        return;
    }
    const json_t *level = json_array_get(json_object_get(study->document, "levels"), i);
    const char *name = study->names[0];
    const double spread = value_inner(json_object_get(level, "spread"), name, "l1");
    buffer_add(to, "<td class=\"n\">");
    html_number(to, case_state_level_error(study->document, name, i));
    if (spread > 0.03) buffer_format(to, " ± %.0f %%", 100 * spread);
    buffer_add(to, "</td>");
}

/* The smallest number of particles above this one in any study; INFINITY: none. */
static double next_n(const struct study *studies, size_t count, double above)
{
    double least = (double)INFINITY;
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < studies[k].levels; i++)
            if (studies[k].n[i] > above) least = fmin(least, studies[k].n[i]);
    return least;
}

/* Explains over which runs the errors are averaged. */
static void replicates_note(struct buffer *to, const json_t *document)
{
    const json_t *level = json_array_get(json_object_get(document, "levels"), 0);
    const double replicates = value_member(level, "replicates");
    if (replicates > 1)
        buffer_format(to,
                      "<p class=\"note\">Means over %.0f runs with n nearby (a random start: "
                      "with as many seeds), ± their standard deviation where it exceeds 3 %%: what "
                      "one run may be off the mean.</p>\n",
                      replicates);
}

static void error_table(struct buffer *to, const struct study *studies, size_t count)
{
    struct buffer columns = {0};
    buffer_add(&columns, "#n");
    for (size_t k = 0; k < count; k++)
        html_format(&columns, "|#%s", value_text(studies[k].document, "label"));
    const json_t *named = NULL;
    for (size_t k = 0; k < count && !named; k++) named = page_study_main(studies[k].document);
    buffer_add(to, "<h4>");
    page_study_name(to, named);
    buffer_add(to, " over n</h4>\n");
    html_table(to, "errors", buffer_text(&columns, to));
    buffer_free(&columns);
    for (double n = 0; isfinite(n = next_n(studies, count, n));) {
        buffer_format(to, "<tr><td class=\"n\">%.0f</td>", n);
        for (size_t k = 0; k < count; k++) error_cell(to, &studies[k], n);
        buffer_add(to, "</tr>\n");
    }
    buffer_add(to, "<tr class=\"total\"><th>order</th>");
    for (size_t k = 0; k < count; k++) html_order_cell(to, page_study_main(studies[k].document));
    buffer_add(to, "</tr>\n");
    html_table_end(to);
    replicates_note(to, studies->document);
}

static void gate_words(struct buffer *to, const json_t *gate)
{
    buffer_add(to, "<td>");
    if (json_is_object(gate)) {
        double low = value_member(gate, "low"), bound = value_member(gate, "bound");
        const double least = value_member(gate, "least");
        if (isfinite(low)) /* else any order is allowed */
            html_format(to, "%f to %f", low, value_member(gate, "high"));
        if (isfinite(bound))
            html_format(to, isfinite(low) ? ", finest ≤ %f" : "finest ≤ %f", bound);
        if (isfinite(least)) html_format(to, ", not below %f", least);
    }
    buffer_add(to, "</td>");
}

static const char *norm_name(const char *norm)
{
    static const char *const names[][2] = {{"l1", "L1"},
                                           {"l1_whole", "L1, whole volumes"},
                                           {"l2", "L2"},
                                           {"linf", "L∞"},
                                           {"particle_mean", "particle mean"}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (!strcmp(norm, names[k][0])) return names[k][1];
    return "error";
}

static void order_rows(struct buffer *to, const struct study *study)
{
    size_t i, j;
    const json_t *order, *pair;
    json_array_foreach(json_object_get(study->document, "orders"), i, order) {
        const char *status = value_text(order, "status");
        bool gated = json_is_object(json_object_get(order, "gate"));
        bool shown = !strcmp(value_text(order, "norm"), "l1") || is_scalar(order);
        if (!gated && !shown && strcmp(status, "fail")) continue;
        html_format(to,
                    "<tr><td>%s</td><td>%s of %-s</td><td class=\"n\">%.2f</td>"
                    "<td class=\"n\">%.2f to %.2f</td><td>",
                    value_text(study->document, "label"), norm_name(value_text(order, "norm")),
                    value_text(order, "field"), value_member(order, "order"),
                    value_member(order, "low"), value_member(order, "high"));
        json_array_foreach(json_object_get(order, "pairwise"), j, pair)
            buffer_format(to, "%s%.2f", j ? ", " : "", value_real(pair));
        buffer_add(to, "</td>");
        gate_words(to, json_object_get(order, "gate"));
        buffer_add(to, "<td>");
        if (gated) html_status(to, status);
        const char *why = value_text_or(order, "known", value_text(order, "why"));
        if (gated && *why) html_format(to, ": %s", why);
        buffer_add(to, "</td></tr>\n");
    }
}

static void order_table(struct buffer *to, const struct study *studies, size_t count)
{
    bool failed = false;
    for (size_t k = 0; k < count; k++) {
        size_t i;
        const json_t *order;
        json_array_foreach(json_object_get(studies[k].document, "orders"), i, order)
            failed = failed || !strcmp(value_text(order, "status"), "fail");
    }
    buffer_format(to,
                  "<details%s><summary>Orders of all quantities, and what is expected</summary>\n",
                  failed ? " open=\"open\"" : "");
    html_table(to, "orders", "scheme|error|#order|#95 % interval|pairwise|expected|");
    for (size_t k = 0; k < count; k++) order_rows(to, &studies[k]);
    html_table_end(to);
    buffer_add(to, "</details>\n");
}

/* Writes the class of a scalar's convergence. The class refers to differences between levels, which
 * may grow although the error decreases; the text then says so. */
static void class_words(struct buffer *to, const json_t *entry)
{
    const char *class = value_text(entry, "class");
    const json_t *values = json_object_get(entry, "values");
    const double exact = value_member(entry, "exact");
    bool nearer = json_array_size(values) > 1;
    for (size_t i = 1; i < json_array_size(values); i++)
        nearer = nearer && fabs(value_real(json_array_get(values, i)) - exact) <
                               fabs(value_real(json_array_get(values, i - 1)) - exact);
    buffer_escape(to, strcmp(class, "diverging") ? class
                      : nearer                   ? "its error falls, by irregular steps"
                                                 : "its steps do not get smaller");
}

static void finest_value(struct buffer *to, const json_t *values)
{
    html_digits(to, value_real(json_array_get(values, json_array_size(values) - 1)));
}

static void percent(struct buffer *to, const json_t *part)
{
    html_format(to, "%f %%", 100 * value_real(part));
}

static const struct html_column functionals[] = {
    COLUMN("scheme", "^label", .kind = CELL_TEXT),
    COLUMN("scalar", "name", .kind = CELL_WORDS),
    COLUMN("#finest level", "values", .cell = finest_value),
    COLUMN("#extrapolated", "extrapolated", .kind = CELL_DIGITS, .otherwise = "—", .finite = true),
    COLUMN("#exact", "exact", .kind = CELL_DIGITS),
    COLUMN("#order", "order", .otherwise = "—", .finite = true),
    COLUMN("#GCI, finest", "gci", .cell = percent, .otherwise = "—", .finite = true),
    COLUMN("#GCI, next", "gci_coarse", .cell = percent, .otherwise = "—", .finite = true),
    COLUMN("convergence", NULL, .cell = class_words),
    {0}};

/* Writes the extrapolated scalars of the final state and their uncertainty. */
static void functional_table(struct buffer *to, const json_t *const *studies, size_t count)
{
    size_t all = 0;
    for (size_t k = 0; k < count; k++)
        all += json_array_size(json_object_get(studies[k], "functionals"));
    if (!all) return;
    buffer_add(to, "<details><summary>Scalars extrapolated, with their grid convergence index"
                   "</summary>\n");
    html_lists(to, "functionals", functionals, studies, count, "functionals");
    buffer_add(to, "<p class=\"note\">Richardson's extrapolation and Roache's grid convergence "
                   "index (GCI: 1.25 times the estimated relative error) of the finest levels; "
                   "only where convergence is asymptotic.</p></details>\n");
}

void page_study(struct page_writer *writer, const char *case_name, const json_t *const *documents,
                size_t count)
{
    struct buffer *to = &writer->to;
    struct study *studies = page_allocate(to, count, sizeof *studies);
    if (!studies) return;
    for (size_t k = 0; k < count; k++) read_study(&studies[k], documents[k]);
    buffer_add(to, "<div class=\"figures\">\n");
    plot_convergence(writer, case_name, studies, count);
    buffer_add(to, "<div>");
    error_table(to, studies, count);
    buffer_add(to, "</div></div>\n");
    order_table(to, studies, count);
    functional_table(to, documents, count);
    page_budget(writer, documents, count);
    free(studies);
}
