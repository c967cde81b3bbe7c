/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient league table and kernel certificates. */
#include <math.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

/* Writes a cell for a string, a number, or a boolean as yes or no. */
static void flat_cell(struct buffer *to, const json_t *value)
{
    if (json_is_boolean(value)) {
        html_cell(to, json_is_true(value) ? "yes" : "no");
    } else if (json_is_null(value)) {
        html_cell(to, "—");
    } else if (json_is_string(value) && !value_is_real(value)) {
        html_format(to, "<td>%-s</td>", json_string_value(value));
    } else {
        html_cell_number(to, value_real(value));
    }
}

/* Writes the highest degree of polynomials for which an operator is exact. */
static void degree_cell(struct buffer *to, double degree)
{
    static const char *const names[] = {"nothing", "constants", "linear", "quadratic", "cubic"};
    html_cell(to, isfinite(degree) ? names[degree < 0 ? 0 : (int)fmin(degree + 1, 4)] : "—");
}

/* True for "exact_degree_lattice" and the like; the dimension is in the heading. */
static bool is_degree(const char *name)
{
    return strstr(name, "exact_degree") == name;
}

static void league_head(struct buffer *to, const json_t *row)
{
    const char *name;
    const json_t *value;
    struct buffer columns = {0};
    json_object_foreach((json_t *)row, name, value) {
        if (!strcmp(name, "dim")) continue;
        if (columns.size) buffer_add(&columns, "|");
        if (!json_is_string(value) && !is_degree(name)) buffer_add(&columns, "#");
        html_words(&columns, is_degree(name) ? name + 6 : name);
    }
    html_table(to, "league", buffer_text(&columns, to));
    buffer_free(&columns);
}

static void league_row(struct buffer *to, const json_t *row)
{
    const char *name;
    const json_t *value;
    buffer_add(to, "<tr>");
    json_object_foreach((json_t *)row, name, value) {
        if (!strcmp(name, "dim")) continue;
        if (is_degree(name))
            degree_cell(to, value_real(value));
        else
            flat_cell(to, value);
    }
    buffer_add(to, "</tr>\n");
}

/* Draws error against momentum defect: no gradient has both small. */
static void plot_league(struct page_writer *writer, const json_t *rows)
{
    enum { DIMENSIONS = 3 };
    struct plot_series series[PAGE_SCHEMES];
    double defect[PAGE_SCHEMES][DIMENSIONS], error[PAGE_SCHEMES][DIMENSIONS];
    size_t count = 0, i;
    const json_t *row;
    json_array_foreach(rows, i, row) {
        const char *name = value_text(row, "operator");
        size_t k = 0;
        while (k < count && strcmp(series[k].label, name)) k++;
        if (k == PAGE_SCHEMES) continue;
        if (k == count)
            series[count++] = (struct plot_series){
                .label = name, .kind = PLOT_POINTS, .x = defect[k], .y = error[k]};
        size_t n = series[k].n;
        if (n == DIMENSIONS) continue;
        defect[k][n] = fmax(value_member(row, "momentum_defect"), 1e-18);
        error[k][n] = value_member(row, "error_disordered");
        series[k].n++;
    }
    const struct plot_panel panel = {.x_label = "momentum defect of the pair forces",
                                     .y_label = "error on disordered points",
                                     .x_log = true,
                                     .y_log = true,
                                     .key = PLOT_KEY_TOP,
                                     .series = series,
                                     .series_count = count};
    const struct plot plot = {.name = "gradients",
                              .title = "Gradient operators: error against momentum defect",
                              .panels = &panel,
                              .panel_count = 1};
    if (!count) return;
    buffer_add(&writer->to, "<div class=\"figures\">");
    page_plot(writer, &plot,
              "A point for each of 1D, 2D and 3D. To the left: momentum is conserved; below: the "
              "gradient of a smooth field is right on disordered points.");
    buffer_add(&writer->to, "</div>\n");
}

void page_gradients(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *gradients = json_object_get(results, "gradients");
    const json_t *rows = json_object_get(gradients, "rows"), *row;
    size_t i;
    buffer_add(to,
               "<section id=\"gradients\"><h2>Gradient operators: league table</h2>\n<p>What an "
               "operator gains in exactness on disordered points it pays for in conservation: "
               "an antisymmetric form keeps momentum to round-off, a linearly exact one does "
               "not. Errors are those of a smooth field's gradient, times h over its largest "
               "value.</p>\n");
    plot_league(writer, rows);
    double dim = (double)NAN;
    json_array_foreach(rows, i, row) {
        double now = value_member(row, "dim");
        if (now != dim) {
            if (i) html_table_end(to);
            buffer_format(to, "<h3>%.0fD</h3>\n", now);
            league_head(to, row);
            dim = now;
        }
        league_row(to, row);
    }
    if (json_array_size(rows)) html_table_end(to);
    html_command(to, "see it again:", value_text(gradients, "reproduce"));
    buffer_add(to, "</section>\n");
}

static size_t failed_checks(const json_t *kernel)
{
    const json_t *check;
    size_t i, failed = 0;
    json_array_foreach(json_object_get(kernel, "checks"), i, check)
        failed += !strcmp(value_text(check, "status"), "fail");
    return failed;
}

static void kernel_name(struct buffer *to, const json_t *kernel)
{
    html_status(to, failed_checks(kernel) ? "fail" : "pass");
    html_format(to, " <code>%s</code>", value_text(kernel, "kernel"));
}

static void off_one(struct buffer *to, const json_t *normalisation)
{
    html_number(to, fabs(1 - value_real(normalisation)));
}

static void hold(struct buffer *to, const json_t *kernel)
{
    const size_t all = json_array_size(json_object_get(kernel, "checks"));
    buffer_format(to, "%zu of %zu", all - failed_checks(kernel), all);
}

static const struct html_column certificates[] = {
    COLUMN("kernel", NULL, .cell = kernel_name),
    COLUMN("#dim", "dim"),
    COLUMN("class", "class", .format = "C%.0f"),
    COLUMN("#1 − ∫W dV", "normalisation", .cell = off_one),
    COLUMN("#sigma/h", "moments/sigma"),
    COLUMN("#least of transform Ŵ", "fourier/min"),
    COLUMN("#Ŵ &lt; 0 from kh", "fourier/first_negative_k", .otherwise = "never"),
    COLUMN("#pairs from N", "pairing_neighbours", .otherwise = "never"),
    COLUMN("#hold", NULL, .cell = hold),
    COLUMN("certificate", "reproduce", .kind = CELL_CODE),
    {0}};

void page_kernels(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    buffer_add(to,
               "<section id=\"kernels\"><h2>Kernel certificates</h2>\n<p>Particles pair "
               "from the number of neighbours N on at which coincident pairs have less energy than "
               "single particles on the densest lattice; with a Fourier transform that is nowhere "
               "negative they never do.</p>\n");
    html_list(to, "kernels", certificates, json_object_get(results, "kernels"), NULL);
    buffer_add(to, "</section>\n");
}
