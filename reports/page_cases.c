/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cases: profiles over the exact solution, residuals, convergence, tables. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_state.h"
#include "html.h"
#include "page_part.h"
#include "value.h"

enum { X, DENSITY, VELOCITY, PRESSURE, ENERGY, COLUMNS };
enum { QUANTITIES = COLUMNS - 1 };

static const char *const value_names[] = {"x", "density", "velocity", "pressure"},
                         *const exact_names[] = {"x", "exact_density", "exact_velocity",
                                                 "exact_pressure"};

/* Data for the plots of a case; residual: of particles, those of their values. */
struct curves {
    size_t runs;
    const char *label[PAGE_SCHEMES];
    struct page_columns value[PAGE_SCHEMES], residual[PAGE_SCHEMES], exact;
};

/* Reads positions, densities, velocities and pressures, and computes internal energies. */
static void read_columns(struct buffer *to, struct page_columns *columns, const json_t *from,
                         const char *const *names, double gamma)
{
    page_columns_read(to, columns, from, names, ENERGY);
    const double *rho = columns->of[DENSITY], *P = columns->of[PRESSURE];
    double *u = columns->n ? page_allocate(to, columns->n, sizeof *u) : NULL;
    for (size_t i = 0; u && i < columns->n; i++) u[i] = P[i] / ((gamma - 1) * rho[i]);
    columns->of[ENERGY] = u;
}

static void add_curve(struct buffer *to, struct curves *curves, const json_t *run)
{
    const json_t *profile = json_object_get(run, "profile");
    const json_t *exact = json_object_get(profile, "exact");
    const double gamma = value_inner(run, "settings", "gamma");
    const size_t k = curves->runs;
    struct page_columns *value = &curves->value[k], *residual = &curves->residual[k];
    if (!profile) return;
    curves->label[k] = value_text(run, "label");
    read_columns(to, value, profile, value_names, gamma);
    read_columns(to, residual, profile, exact_names, gamma);
    if (residual->n < value->n) value->n = residual->n;
    for (int q = DENSITY; q < COLUMNS; q++)
        for (size_t i = 0; value->of[q] && residual->of[q] && i < value->n; i++)
            residual->of[q][i] = value->of[q][i] - residual->of[q][i];
    curves->runs++;
    if (!exact || curves->exact.n) return;
    page_columns_free(&curves->exact);
    read_columns(to, &curves->exact, exact, value_names, gamma);
}

static void free_curves(struct curves *curves)
{
    for (size_t k = 0; k < curves->runs; k++)
        page_columns_free(&curves->value[k]), page_columns_free(&curves->residual[k]);
    page_columns_free(&curves->exact);
}

/* Draws particles over the exact solution, or their residuals. */
static void plot_curves(struct page_writer *writer, const char *case_name,
                        const struct curves *curves, bool residuals)
{
    static const char *const labels[][QUANTITIES] = {
        {"density", "velocity", "pressure", "internal energy"},
        {"Δ density", "Δ velocity", "Δ pressure", "Δ internal energy"}};
    static const struct plot_mark zero = {0, true, NULL};
    struct plot_series series[QUANTITIES][PAGE_SCHEMES + 1];
    struct plot_panel panels[QUANTITIES] = {0};
    for (int q = 0; q < QUANTITIES; q++) {
        size_t n = 0;
        if (curves->exact.of[X] && !residuals)
            series[q][n++] = (struct plot_series){.label = "exact",
                                                  .kind = PLOT_LINES,
                                                  .n = curves->exact.n,
                                                  .x = curves->exact.of[X],
                                                  .y = curves->exact.of[q + 1],
                                                  .color = PLOT_NEUTRAL};
        for (size_t k = 0; k < curves->runs; k++)
            series[q][n++] = (struct plot_series){
                .label = curves->label[k],
                .kind = residuals ? PLOT_LINES : PLOT_POINTS,
                .n = curves->value[k].n,
                .x = curves->value[k].of[X],
                .y = (residuals ? curves->residual : curves->value)[k].of[q + 1],
                .color = (int)k + 1,
                .size = 0.5};
        panels[q] = (struct plot_panel){.x_label = "position x",
                                        .y_label = labels[residuals][q],
                                        .key = q ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[q],
                                        .series_count = n,
                                        .marks = &zero,
                                        .mark_count = residuals};
    }
    char name[96];
    page_plot_name(name, sizeof name, case_name, residuals ? "residuals" : "profiles");
    const struct plot plot = {
        .name = name,
        .title = residuals ? "Residuals: particle minus exact solution"
                           : "Profiles of density, velocity, pressure and internal energy",
        .panels = panels,
        .panel_count = QUANTITIES};
    page_plot(writer, &plot,
              residuals ? "The same particles minus the exact solution."
                        : "Each point is a particle; the line is the exact solution.");
}

static void percent_cell(struct buffer *to, double part)
{
    if (isfinite(part))
        buffer_format(to, "<td class=\"n\">%.2g %%</td>", 100 * part);
    else
        buffer_add(to, "<td class=\"n\">—</td>");
}

static const struct html_column run_columns[] = {
    COLUMN("scheme", "label", .kind = CELL_TEXT),
    COLUMN("#n", "n"),
    COLUMN("#L1 density", "errors/density/l1", .otherwise = "—"),
    COLUMN("#L1 velocity", "errors/velocity/l1", .otherwise = "—"),
    COLUMN("#L1 pressure", "errors/pressure/l1", .otherwise = "—"),
    COLUMN("#L1 internal energy", "errors/internal_energy/l1", .otherwise = "—"),
    COLUMN("#mass", "conservation/mass", .otherwise = "—"),
    COLUMN("#momentum", "conservation/momentum", .otherwise = "—"),
    COLUMN("#energy", "conservation/energy", .otherwise = "—"),
    COLUMN("#steps", "cost/steps", .otherwise = "—"),
    COLUMN("#CPU s", "cost/cpu_s", .otherwise = "—"),
    COLUMN("", "status", .kind = CELL_STATUS),
    {0}};

/* ---- deviations of a profile from the exact solution ---- */

static void range(const double *values, size_t n, double *low, double *high)
{
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (size_t i = 0; values && i < n; i++) {
        *low = fmin(*low, values[i]);
        *high = fmax(*high, values[i]);
    }
}

/* How far values exceed the range of the exact solution, as a fraction of that range. */
static double overshoot(const struct curves *curves, size_t k, int q)
{
    double low, high, exact_low, exact_high;
    range(curves->exact.of[q], curves->exact.n, &exact_low, &exact_high);
    range(curves->value[k].of[q], curves->value[k].n, &low, &high);
    return fmax(0, fmax(high - exact_high, exact_low - low)) / (exact_high - exact_low);
}

/* Position where the density jumps and the pressure does not; NaN: none. The exact curve has two
 * points at a jump. */
static double contact_of(const struct curves *curves)
{
    const struct page_columns *exact = &curves->exact;
    const double *rho = exact->of[DENSITY], *P = exact->of[PRESSURE], *x = exact->of[X];
    double low, high, at = (double)NAN;
    range(rho, exact->n, &low, &high);
    double most = 0.01 * (high - low);
    for (size_t i = 0; i + 1 < exact->n; i++) {
        const double jump = fabs(rho[i + 1] - rho[i]);
        if (jump <= most || fabs(P[i + 1] - P[i]) > 1e-6 * fabs(P[i])) continue;
        most = jump;
        at = (x[i] + x[i + 1]) / 2;
    }
    return at;
}

/* Largest relative error of the pressure within four smoothing lengths of the contact. */
static double pressure_blip(const struct curves *curves, size_t k, double contact, double h)
{
    double most = (double)NAN;
    const struct page_columns *value = &curves->value[k];
    const double *P = value->of[PRESSURE], *error = curves->residual[k].of[PRESSURE];
    for (size_t i = 0; i < value->n; i++)
        if (fabs(value->of[X][i] - contact) <= 4 * h)
            most = fmax(most, fabs(error[i] / (P[i] - error[i])));
    return most;
}

static void shape_table(struct buffer *to, const struct curves *curves, const json_t *const *runs)
{
    const double contact = contact_of(curves);
    html_table(to, "shape",
               "scheme|#density|#velocity|#pressure|#internal energy|#pressure at the contact");
    for (size_t k = 0; k < curves->runs; k++) {
        buffer_add(to, "<tr>");
        html_cell(to, curves->label[k]);
        for (int q = DENSITY; q < COLUMNS; q++) percent_cell(to, overshoot(curves, k, q));
        percent_cell(to, pressure_blip(curves, k, contact, value_member(runs[k], "h")));
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
    buffer_add(to, "<p class=\"note\">How far particles go beyond the range of the exact solution, "
                   "as a part of that range, and the largest error of pressure within 4 h of the "
                   "contact, where density jumps and pressure should not.</p>\n");
}

/* ---- one case ---- */

static bool is_failure(const char *state)
{
    return !strcmp(state, "fail") || !strcmp(state, "broke_down") || !strcmp(state, "failed");
}

/* Writes the summary line of a case, which is visible when the case is folded. */
static void case_head(struct buffer *to, const char *name, const json_t *title,
                      const json_t *const *studies, size_t study_count, const char *state)
{
    buffer_format(to, "<details class=\"case\" id=\"case-%s\"%s>", name,
                  is_failure(state) ? " open=\"open\"" : "");
    html_format(to, "<summary><h3><code>%s</code> <span>%s</span></h3>", name,
                title ? json_string_value(title) : "");
    html_status(to, state);
    bool shown = false;
    for (size_t k = 0; k < study_count; k++) {
        const json_t *order = page_study_main(studies[k]);
        if (!order) continue; /* the study failed */
        if (!shown) buffer_add(to, " <span class=\"note\">order of ");
        if (!shown) page_study_name(to, order);
        html_format(to, shown ? ", %s " : ": %s ", value_text(studies[k], "label"));
        html_order(to, order);
        shown = true;
    }
    buffer_format(to, "%s</summary>\n", shown ? "</span>" : "");
}

static int dimension_of(const json_t *document)
{
    const double dimension = value_member(document, "dimension");
    return isfinite(dimension) ? (int)dimension : 1;
}

static bool is_cloud(const json_t *const *runs, size_t count)
{
    return count && dimension_of(runs[0]) > 1;
}

static void one_case(struct page_writer *writer, const json_t *results, const char *name)
{
    struct buffer *to = &writer->to;
    const json_t *runs[PAGE_SCHEMES], *studies[PAGE_SCHEMES], *entry, *title = NULL;
    struct curves curves = {0};
    size_t i, run_count = 0, study_count = 0;
    json_array_foreach(json_object_get(results, "runs"), i, entry) {
        if (strcmp(value_text(entry, "case"), name) || run_count == PAGE_SCHEMES) continue;
        runs[run_count++] = entry;
        if (dimension_of(entry) == 1) add_curve(to, &curves, entry);
        if (!title) title = json_object_get(entry, "title");
    }
    json_array_foreach(json_object_get(results, "studies"), i, entry) {
        if (strcmp(value_text(entry, "case"), name) || study_count == PAGE_SCHEMES) continue;
        studies[study_count++] = entry;
    }
    const char *state = case_state(results, name);
    case_head(to, name, title, studies, study_count, state);
    const size_t inside = to->size;
    buffer_add(to, "<div class=\"figures\">\n");
    if (is_cloud(runs, run_count)) {
        buffer_add(to, "</div>\n");
        page_cloud_plots(writer, name, runs, run_count, false);
    } else {
        for (int residuals = 0; curves.runs && residuals < 2; residuals++)
            plot_curves(writer, name, &curves, residuals);
    }
    buffer_add(to, "</div>\n");
    if (study_count) page_study(writer, name, studies, study_count);
    if (is_cloud(runs, run_count)) {
        page_cloud_tables(to, runs, run_count);
    } else if (run_count) {
        buffer_add(to, "<h4>Errors, conservation and cost of the runs above</h4>\n");
        html_lists(to, "runs", run_columns, runs, run_count, NULL);
    }
    if (!is_cloud(runs, run_count) && curves.runs && curves.runs == run_count) {
        buffer_add(to, "<h4>Overshoots</h4>\n");
        shape_table(to, &curves, runs);
    }
    buffer_add(to, "<div class=\"figures\">\n");
    page_time(writer, name, runs, run_count);
    buffer_add(to, "<div>");
    for (i = 0; i < run_count; i++)
        html_command(to, value_text(runs[i], "label"), value_text(runs[i], "reproduce"));
    for (i = 0; i < study_count; i++)
        html_command(to, "convergence", value_text(studies[i], "reproduce"));
    buffer_add(to, "</div></div>\n");
    if (!is_failure(state)) fold_seal(to, inside);
    buffer_add(to, "</details>\n");
    free_curves(&curves);
}

static bool seen_before(const json_t *list, size_t before, const char *name)
{
    for (size_t i = 0; i < before; i++)
        if (!strcmp(value_text(json_array_get(list, i), "case"), name)) return true;
    return false;
}

/* Writes the cases of one dimension, if any. */
static void cases_in(struct page_writer *writer, const json_t *results, int dimension, bool folded)
{
    const json_t *runs = json_object_get(results, "runs"), *entry;
    const json_t *studies = json_object_get(results, "studies");
    size_t i, count = 0;
    bool failed = false;
    json_array_foreach(runs, i, entry) {
        if (dimension_of(entry) != dimension || seen_before(runs, i, value_text(entry, "case")))
            continue;
        count++;
        failed = failed || is_failure(case_state(results, value_text(entry, "case")));
    }
    if (folded && count)
        buffer_format(&writer->to,
                      "<details class=\"dimension\"%s><summary>In %dD: %zu case%s</summary>\n",
                      failed ? " open=\"open\"" : "", dimension, count, count == 1 ? "" : "s");
    json_array_foreach(runs, i, entry) {
        const char *name = value_text(entry, "case");
        if (dimension_of(entry) == dimension && !seen_before(runs, i, name))
            one_case(writer, results, name);
    }
    json_array_foreach(studies, i, entry) {
        const char *name = value_text(entry, "case");
        if (dimension_of(entry) == dimension && !seen_before(studies, i, name) &&
            !seen_before(runs, json_array_size(runs), name))
            one_case(writer, results, name);
    }
    if (folded && count) buffer_add(&writer->to, "</details>\n");
}

void page_cases(struct page_writer *writer, const json_t *results)
{
    const json_t *runs = json_object_get(results, "runs"), *entry;
    bool clouds = false;
    size_t i;
    if (!json_array_size(runs) && !json_array_size(json_object_get(results, "studies"))) return;
    buffer_add(&writer->to, "<section id=\"cases\"><h2>Cases against their exact solutions</h2>\n");
    json_array_foreach(runs, i, entry) clouds = clouds || dimension_of(entry) > 1;
    for (int dimension = 1; dimension <= 3; dimension++)
        cases_in(writer, results, dimension, clouds);
    buffer_add(&writer->to, "</section>\n");
}
