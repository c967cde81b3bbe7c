/* SPDX-License-Identifier: GPL-3.0-or-later
 * The stability atlas: growth rates of linear theory, and maps of the stress test, one table per
 * group, with cells coloured by outcome. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

enum { POINTS = 128, CURVES = 8, MAP_MAX = 64 * 64 };

/* --- linear theory -----------------------------------------------------------------------------
 */

struct curve {
    char label[64];
    double x[POINTS], y[POINTS];
};

static void label_of(struct buffer *to, char label[64], const json_t *row, bool eta)
{
    struct buffer words = {0};
    html_words(&words, value_text(row, "kernel"));
    if (eta)
        buffer_format(&words, ", %s, eta %g%s", value_text(row, "gradient"),
                      value_member(row, "eta"), value_member(row, "alpha") > 0 ? ", viscous" : "");
    snprintf(label, 64, "%s", buffer_text(&words, to));
    buffer_free(&words);
}

/* Draws growth against eta for one gradient, if any growth is visible. */
static void plot_growth(struct page_writer *writer, const json_t *atlas, const char *gradient)
{
    static const double least = 1e-4;
    struct curve *curves = page_allocate(&writer->to, CURVES, sizeof *curves);
    struct plot_series series[CURVES];
    const json_t *rows = json_object_get(atlas, "rows"), *row;
    size_t i, count = 0;
    json_array_foreach(rows, i, row) {
        if (!curves || count == CURVES || strcmp(value_text(row, "gradient"), gradient)) continue;
        struct curve *curve = &curves[count];
        const size_t n = value_reals(json_object_get(atlas, "eta"), curve->x, POINTS);
        value_reals(json_object_get(row, "growth"), curve->y, POINTS);
        bool seen = false;
        for (size_t k = 0; k < n; k++) {
            if (!(curve->y[k] >= least)) curve->y[k] = (double)NAN;
            seen = seen || curve->y[k] >= least;
        }
        if (!seen) continue;
        label_of(&writer->to, curve->label, row, false);
        series[count++] = (struct plot_series){.label = curve->label,
                                               .kind = PLOT_LINES_POINTS,
                                               .n = n,
                                               .x = curve->x,
                                               .y = curve->y,
                                               .size = 0.5};
    }
    char name[96];
    page_plot_name(name, sizeof name, "growth", gradient);
    const struct plot_panel panel = {.x_label = "eta, width in spacings",
                                     .y_label = "fastest growth [c/dx]",
                                     .y_log = true,
                                     .x_min = 1,
                                     .x_max = 9.5,
                                     .key = PLOT_KEY_TOP,
                                     .series = series,
                                     .series_count = count};
    struct buffer title = {0};
    buffer_format(&title, "Growth of the fastest wave, %s gradient, no viscosity", gradient);
    const struct plot plot = {.name = name,
                              .title = buffer_text(&title, &writer->to),
                              .height = 360,
                              .panels = &panel,
                              .panel_count = 1};
    if (count)
        page_plot(writer, &plot,
                  !strcmp(gradient, "ia")
                      ? "The Integral Approach's gradient: a kernel that is not shown, and a width "
                        "without a point, is stable."
                      : "The standard gradient: only kernels that are ever unstable are shown.");
    buffer_free(&title);
    free(curves);
}

/* Draws frequency and growth against the wavenumber. */
static void plot_waves(struct page_writer *writer, const json_t *waves)
{
    struct curve *curves = page_allocate(&writer->to, 2 * CURVES, sizeof *curves);
    struct plot_series series[2][CURVES];
    size_t i, count = 0;
    const json_t *row;
    json_array_foreach(waves, i, row) {
        if (!curves || count == CURVES) break;
        static const char *const what[] = {"frequency", "growth"};
        for (int k = 0; k < 2; k++) {
            struct curve *curve = &curves[2 * count + (size_t)k];
            const size_t n = value_reals(json_object_get(row, "kappa"), curve->x, POINTS);
            value_reals(json_object_get(row, what[k]), curve->y, POINTS);
            label_of(&writer->to, curve->label, row, true);
            series[k][count] = (struct plot_series){.label = k ? NULL : curve->label,
                                                    .kind = PLOT_LINES,
                                                    .n = n,
                                                    .x = curve->x,
                                                    .y = curve->y,
                                                    .color = (int)count + 1};
        }
        count++;
    }
    const struct plot_panel panels[] = {{.y_label = "frequency [c/dx]",
                                         .key = PLOT_KEY_TOP,
                                         .series = series[0],
                                         .series_count = count},
                                        {.x_label = "wavenumber k dx (pi: two particles a wave)",
                                         .y_label = "growth [c/dx]",
                                         .key = PLOT_KEY_NONE,
                                         .series = series[1],
                                         .series_count = count}};
    const struct plot plot = {.name = "dispersion",
                              .title = "Frequency and growth of waves on a lattice",
                              .height = 460,
                              .panels = panels,
                              .panel_count = 2};
    if (count)
        page_plot(
            writer, &plot,
            "Waves on a uniform lattice; sound would be the straight line frequency = k. "
            "Where the frequency falls to zero, the wave grows; viscosity (alpha = 1, on half "
            "of the pairs) damps it and hides a slow growth.");
    free(curves);
}

/* Draws growth against eta and wavenumber. */
static void plot_map(struct page_writer *writer, const json_t *map)
{
    static double eta[POINTS], kappa[POINTS], growth[MAP_MAX];
    const size_t nx = value_reals(json_object_get(map, "eta"), eta, POINTS);
    const size_t ny = value_reals(json_object_get(map, "kappa"), kappa, POINTS);
    const size_t n = value_reals(json_object_get(map, "growth"), growth, MAP_MAX);
    for (size_t k = 0; k < MAP_MAX; k++)
        if (!(growth[k] > 1e-4)) growth[k] = (double)NAN;
    const struct plot_heat heat = {
        .nx = nx, .ny = ny, .x = eta, .y = kappa, .z = growth, .label = "growth [c/dx]"};
    const struct plot_panel panel = {.x_label = "eta, width in spacings",
                                     .y_label = "wavenumber k dx",
                                     .key = PLOT_KEY_NONE,
                                     .heat = &heat};
    const struct plot plot = {.name = "growth-map",
                              .title = "Growth over width and wavenumber, cubic spline, ia",
                              .height = 360,
                              .panels = &panel,
                              .panel_count = 1};
    if (nx && ny && n == nx * ny)
        page_plot(writer, &plot,
                  "Cubic spline with the Integral Approach's gradient: empty is stable; the first "
                  "waves to grow are the shortest.");
}

/* --- maps --------------------------------------------------------------------------------------
 */

static bool is_number(const json_t *entry, const char *name)
{
    return json_is_number(json_object_get(entry, name));
}

/* stable_below: a smaller predicted growth counts as stable; NaN: no prediction. */
static void cell(struct buffer *to, const json_t *entry, double stable_below)
{
    const char *outcome = value_text(entry, "outcome");
    html_format(to, "<td class=\"%s\" title=\"%s%s%s\">", outcome, value_text(entry, "reason"),
                *value_text(entry, "reason") ? ": " : "", value_text(entry, "command"));
    /* not distinguished by colour alone */
    if (!strcmp(outcome, "inaccurate")) buffer_add(to, "≉ ");
    if (!strcmp(outcome, "wrong")) buffer_add(to, "≠ ");
    const bool measured = is_number(entry, "measured"), predicted = is_number(entry, "predicted");
    const bool stable = predicted && !measured && value_member(entry, "predicted") < stable_below;
    if (stable) buffer_add(to, "stable");
    if (measured) html_number(to, value_member(entry, "measured"));
    if (predicted && !stable)
        html_format(to, measured ? " <span>of %f</span>" : "%f", value_member(entry, "predicted"));
    if (!measured && !predicted) html_words(to, strcmp(outcome, "ok") ? outcome : "none");
    buffer_add(to, "</td>");
}

static bool belongs(const json_t *entry, const char *group, const char *row)
{
    return !strcmp(value_text(entry, "group"), group) &&
           (!row || !strcmp(value_text(entry, "row"), row));
}

/* Lists the cells that are not ok, with commands to reproduce them. */
static void reasons(struct buffer *to, const char *group, const json_t *cells)
{
    size_t i, count = 0;
    const json_t *entry;
    json_array_foreach(cells, i, entry)
        count += belongs(entry, group, NULL) && strcmp(value_text(entry, "outcome"), "ok");
    if (!count) return;
    buffer_format(to, "<details><summary>%zu %s</summary>\n", count,
                  count == 1 ? "cell that is not ok" : "cells that are not ok");
    json_array_foreach(cells, i, entry) {
        if (!belongs(entry, group, NULL) || !strcmp(value_text(entry, "outcome"), "ok")) continue;
        html_format(to, "<p><b>%s, %s</b>: %s</p>", value_text(entry, "row"),
                    value_text(entry, "column"), value_text(entry, "reason"));
        html_command(to, "", value_text(entry, "command"));
    }
    buffer_add(to, "</details>\n");
}

static void map(struct buffer *to, const json_t *group, const json_t *cells)
{
    const json_t *rows = json_object_get(group, "rows"),
                 *columns = json_object_get(group, "columns"), *row, *column, *entry;
    const char *name = value_text(group, "name");
    size_t r, c, i;
    html_format(to,
                "<h3><code>%s</code> <span>%s</span></h3>\n<p class=\"facts\">%s</p>\n"
                "<div class=\"scroll\"><table class=\"map\"><thead><tr><th>%s ↓ %s →</th>",
                name, value_text(group, "title"), value_text(group, "number"),
                value_text(group, "row_title"), value_text(group, "column_title"));
    json_array_foreach(columns, c, column)
        html_format(to, "<th>%s</th>", json_string_value(column));
    buffer_add(to, "</tr></thead><tbody>\n");
    json_array_foreach(rows, r, row) {
        buffer_add(to, "<tr>");
        html_cell(to, json_string_value(row));
        json_array_foreach(cells, i, entry)
            if (belongs(entry, name, json_string_value(row)))
                cell(to, entry, value_member(group, "stable_below"));
        buffer_add(to, "</tr>\n");
    }
    buffer_add(to, "</tbody></table></div>\n");
    html_command(to, "see it again:", value_text(group, "reproduce"));
    reasons(to, name, cells);
}

static void survivors(struct buffer *to, const json_t *comparison)
{
    buffer_format(
        to,
        "<p>The default scheme and the seed program's method, corrected, on the same problems: "
        "both survive %.0f, only the default %.0f, only the seed program's %.0f, neither "
        "%.0f.</p>\n",
        value_member(comparison, "both_survive"), value_member(comparison, "only_default_survives"),
        value_member(comparison, "only_seed_survives"), value_member(comparison, "both_break"));
}

void page_stress(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *stress = json_object_get(results, "stress");
    const json_t *atlas = json_object_get(stress, "atlas"), *group;
    size_t i;
    buffer_add(
        to,
        "<section id=\"stability\"><h2>Stability: what survives, and where it breaks</h2>"
        "\n<p>Linear theory of the whole scheme on a uniform lattice (smoothing length, "
        "density, energy and force varied together) is confirmed by runs that start with noise of "
        "a millionth of the spacing. Maps of hard problems follow.</p>\n");
    if (atlas) {
        buffer_add(to, "<div class=\"figures\">");
        plot_growth(writer, atlas, "ia");
        plot_growth(writer, atlas, "standard");
        plot_waves(writer, json_object_get(atlas, "waves"));
        plot_map(writer, json_object_get(atlas, "map"));
        buffer_add(to, "</div>\n");
    }
    buffer_add(to,
               "<p>The line above each map says what its numbers are; colours are outcomes: <span "
               "class=\"map\"><span class=\"ok\"> ok "
               "</span> <span class=\"inaccurate\"> ≉ inaccurate </span> <span "
               "class=\"broke_down\"> broke down </span></span>. A pointer resting on a cell shows "
               "its reason and its "
               "command.</p>\n");
    survivors(to, json_object_get(stress, "comparison"));
    json_array_foreach(json_object_get(stress, "groups"), i, group) {
        map(to, group, json_object_get(stress, "cells"));
    }
    buffer_add(to, "</section>\n");
}
