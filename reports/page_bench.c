/* SPDX-License-Identifier: GPL-3.0-or-later
 * Work-precision: cost against error for each case. Schemes are sorted by L1^2 x CPU time, best
 * first. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

enum { SHOWN = 12, POINTS = 64, NAME = 96 };

struct curve {
    const json_t *scheme;
    char name[NAME]; /* values without their keys */
    size_t n;
    double cpu[POINTS], error[POINTS];
};

/* "kernel=cubic_spline gradient=ia" is "cubic spline, ia". */
static void short_name(struct buffer *to, char name[NAME], const char *scheme)
{
    struct buffer text = {0};
    for (const char *word = scheme; *word;) {
        const size_t length = strcspn(word, " ");
        const char *value = memchr(word, '=', length);
        const char *from = value ? value + 1 : word;
        if (text.size) buffer_add(&text, value ? ", " : " ");
        buffer_add_bytes(&text, from, (size_t)(word + length - from));
        word += length;
        word += strspn(word, " ");
    }
    snprintf(name, NAME, "%s", buffer_text(&text, to));
    for (; *name; name++)
        if (*name == '_') *name = ' ';
    buffer_free(&text);
}

static int by_merit(const void *a, const void *b)
{
    double x = value_member(((const struct curve *)a)->scheme, "figure_of_merit");
    double y = value_member(((const struct curve *)b)->scheme, "figure_of_merit");
    if (isnan(x) || isnan(y)) return isnan(x) - isnan(y);
    return (x > y) - (x < y);
}

/* Reads the curves of a document, best first; returns their number. */
static size_t read_curves(struct buffer *to, const json_t *document, struct curve *curves)
{
    size_t count = 0, i;
    const json_t *entry;
    json_array_foreach(json_object_get(document, "schemes"), i, entry) {
        struct curve *curve = &curves[count++];
        *curve = (struct curve){.scheme = entry};
        short_name(to, curve->name, value_text(entry, "scheme"));
    }
    json_array_foreach(json_object_get(document, "points"), i, entry) {
        for (size_t k = 0; k < count; k++) {
            struct curve *curve = &curves[k];
            if (strcmp(value_text(curve->scheme, "scheme"), value_text(entry, "scheme")) ||
                curve->n == POINTS)
                continue;
            curve->cpu[curve->n] = value_member(entry, "cpu_s");
            curve->error[curve->n++] = value_member(entry, "error");
        }
    }
    qsort(curves, count, sizeof *curves, by_merit);
    return count;
}

/* Errors of other codes, without their CPU times, which belong to other machines. 0.148 is the
 * exact amplitude, its factors are 1 - M/reference from cases/README.md. `sphproof run CASE n=N
 * --code verify/examples/codes/athena.ini` reproduces those of Athena++. */
static const struct {
    const char *case_name, *error_of, *label;
    double error;
} others[] = {
    {"gresho", "azimuthal", "MFM, 32^2", 0.0410},
    {"gresho", "azimuthal", "Athena++, 32^2", 0.0208},
    {"gresho", "azimuthal", "Athena++, 64^2", 0.00980},
    {"gresho", "azimuthal", "Athena++, 128^2", 0.00364},
    {"yee", "azimuthal", "Athena++, 32^2", 0.0108},
    {"yee", "azimuthal", "Athena++, 64^2", 0.00174},
    {"yee", "azimuthal", "Athena++, 128^2", 0.00026},
    {"sedov_2d", "pressure", "Athena++, 32^2", 0.133},
    {"sedov_2d", "pressure", "Athena++, 64^2", 0.0774},
    {"sedov_2d", "pressure", "Athena++, 128^2", 0.0457},
    {"kelvin_helmholtz", "mode_amplitude", "MFM, 64^2", 0.69 * 0.148},
    {"kelvin_helmholtz", "mode_amplitude", "MFM, 128^2", 0.27 * 0.148},
    {"kelvin_helmholtz", "mode_amplitude", "Athena++, 64^2", 0.29 * 0.148},
    {"kelvin_helmholtz", "mode_amplitude", "Athena++, 128^2", 0.055 * 0.148},
};
enum { OTHERS = sizeof others / sizeof *others };

static size_t find_others(const json_t *document, struct plot_mark marks[OTHERS])
{
    size_t count = 0;
    for (size_t k = 0; k < OTHERS; k++)
        if (!strcmp(others[k].case_name, value_text(document, "case")) &&
            !strcmp(others[k].error_of, value_text(document, "error_of")))
            marks[count++] = (struct plot_mark){others[k].error, true, others[k].label};
    return count;
}

static void plot_curves(struct page_writer *writer, const json_t *document,
                        const struct curve *curves, size_t count, bool of_codes)
{
    const char *case_name = value_text(document, "case");
    char label[96];
    snprintf(label, sizeof label, "error of %.60s", value_text_or(document, "error_of", "density"));
    for (char *c = label; *c; c++)
        if (*c == '_') *c = ' ';
    struct plot_mark marks[OTHERS];
    const size_t marked = of_codes ? 0 : find_others(document, marks);
    struct plot_series series[PLOT_COLORS];
    size_t used = 0;
    for (size_t k = 0; k < count && used < PLOT_COLORS; k++) {
        if (!curves[k].n) continue;
        series[used] = (struct plot_series){.label = curves[k].name,
                                            .kind = PLOT_LINES_POINTS,
                                            .n = curves[k].n,
                                            .x = curves[k].cpu,
                                            .y = curves[k].error};
        used++;
    }
    const struct plot_panel panel = {.x_label = "CPU time [s]",
                                     .y_label = label,
                                     .x_log = true,
                                     .y_log = true,
                                     .key = PLOT_KEY_END,
                                     .series = series,
                                     .series_count = used,
                                     .marks = marks,
                                     .mark_count = marked};
    char name[NAME];
    page_plot_name(name, sizeof name, case_name, "cost");
    const struct plot plot = {.name = name,
                              .title = "Error against CPU time",
                              .width = 660,
                              .height = 380,
                              .panels = &panel,
                              .panel_count = 1};
    if (used)
        page_plot(writer, &plot,
                  marked ? "Further down and to the left is better. Lines across: what other codes "
                           "gave, at any time (cases/README.md)."
                         : "Further down and to the left is better.");
}

static void scheme_table(struct buffer *to, const struct curve *curves, size_t count)
{
    html_table(to, "costs", "scheme|#error, finest n|#CPU s|#merit|#gain");
    for (size_t k = 0; k < count && k < SHOWN; k++) {
        const struct curve *curve = &curves[k];
        buffer_add(to, "<tr>");
        html_cell(to, curve->name);
        html_cell_number(to, curve->n ? curve->error[curve->n - 1] : (double)NAN);
        html_cell_number(to, curve->n ? curve->cpu[curve->n - 1] : (double)NAN);
        for (size_t v = 0; v < 2; v++) { /* missing for other codes */
            const double value =
                value_member(curve->scheme, v ? "seed_plain_over_this" : "figure_of_merit");
            if (isnan(value))
                html_cell(to, "—");
            else
                html_cell_number(to, value);
        }
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
}

static void cheapest_table(struct buffer *to, const json_t *ways)
{
    size_t i;
    const json_t *way;
    if (!json_array_size(ways)) return;
    html_table(to, "costs", "cheapest way to|#CPU s|scheme");
    json_array_foreach(ways, i, way) {
        char name[NAME];
        short_name(to, name, value_text(way, "scheme"));
        buffer_format(to, "<tr><td>%g %% of the signal</td>", 100 * value_member(way, "target"));
        if (*name)
            html_cell_number(to, value_member(way, "cpu_s"));
        else
            buffer_add(to, "<td class=\"n\">—</td>");
        html_cell(to, *name ? name : "not reached at these resolutions");
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
}

/* of_codes: for other codes, from the levels of their ladders. */
static void explain(struct buffer *to, bool of_codes)
{
    buffer_add(to, of_codes
                       ? "<section id=\"cost\"><h2>What an error costs</h2>\n<p>Each point is the "
                         "mean over the runs of one level of a ladder. CPU time counts all "
                         "processes of a run; another code's includes its start and its files."
                         "</p>\n"
                       : "<section id=\"cost\"><h2>What an error costs</h2>\n<p>Each scheme at "
                         "several resolutions. At order p in d dimensions, the merit "
                         "error^((d+1)/p) × CPU time does not depend on the resolution (L1² for "
                         "shock tubes in 1D, L1 for smooth flow): the gain compares it with the "
                         "seed program's corrected method in plain C, in 2D and 3D with SPH as "
                         "textbooks have it. Times are the least of several samples, taken in "
                         "turn.</p>\n");
}

void page_bench(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *document;
    size_t i;
    const bool of_codes = page_of_codes(results);
    explain(to, of_codes);
    json_array_foreach(json_object_get(results, "bench"), i, document) {
        const size_t most = json_array_size(json_object_get(document, "schemes"));
        struct curve *curves = page_allocate(to, most, sizeof *curves);
        if (!curves) return;
        size_t count = read_curves(to, document, curves);
        html_format(to, "<h3><code>%s</code> <span>%s</span></h3>\n<div class=\"figures\">",
                    value_text(document, "case"), value_text(document, "title"));
        plot_curves(writer, document, curves, count, of_codes);
        buffer_add(to, "<div>");
        scheme_table(to, curves, count);
        cheapest_table(to, json_object_get(document, "cheapest"));
        buffer_add(to, "</div></div>\n");
        html_command(to, "see it again:", value_text(document, "reproduce"));
        free(curves);
    }
    buffer_add(to, "</section>\n");
}
