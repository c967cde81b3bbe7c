/* SPDX-License-Identifier: GPL-3.0-or-later
 * The page of `sphproof compare`: verdict, table, and both sides with the exact solution or as maps
 * with the same colour scale. */
#include <math.h>
#include <string.h>

#include "html.h"
#include "page.h"
#include "page_part.h"
#include "style.h"
#include "value.h"

static const char *const fields[] = {"x", "density", "velocity", "pressure"};
enum { FIELDS_READ = sizeof fields / sizeof *fields, PANELS = FIELDS_READ - 1 };
enum { SIDES = 2, SERIES = SIDES + 1 };

/* Draws both sides and the exact curve, in one panel per field. */
static void lines(struct page_writer *writer, const json_t *const runs[SIDES])
{
    struct plot_series series[PANELS][SERIES];
    struct plot_panel panels[PANELS];
    struct page_columns curves[SERIES];
    bool whole = true;
    for (int s = 0; s < SERIES; s++) {
        const json_t *profile = json_object_get(runs[s < SIDES ? s : 0], "profile");
        if (s == SIDES) profile = json_object_get(profile, "exact");
        whole = page_columns_read(&writer->to, &curves[s], profile, fields, FIELDS_READ) && whole;
    }
    for (int k = 0; k < PANELS && whole; k++) {
        for (int s = 0; s < SERIES; s++)
            series[k][s] =
                (struct plot_series){.label = s < SIDES ? value_text(runs[s], "label") : "exact",
                                     .kind = s < SIDES ? PLOT_POINTS : PLOT_LINES,
                                     .n = curves[s].n,
                                     .x = curves[s].of[0],
                                     .y = curves[s].of[k + 1],
                                     .color = s < SIDES ? s + 1 : PLOT_NEUTRAL,
                                     .size = 0.5};
        panels[k] = (struct plot_panel){.x_label = "x",
                                        .y_label = fields[k + 1],
                                        .key = k ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[k],
                                        .series_count = SERIES};
    }
    const struct plot plot = {.name = "compare-profiles",
                              .title = "a and b over the exact solution",
                              .panels = panels,
                              .panel_count = PANELS};
    if (whole)
        page_plot(writer, &plot,
                  "Particles of the first draw over the exact solution, code units.");
    for (int s = 0; s < SERIES; s++) page_columns_free(&curves[s]);
}

static void table(struct buffer *to, const json_t *document)
{
    const json_t *figure, *cpu = json_object_get(document, "cpu");
    size_t k;
    html_table(to, "errors", "error|#a|#b|#b/a - 1 in %|b is");
    json_array_foreach(json_object_get(document, "comparisons"), k, figure) {
        const double change = value_member(figure, "change"), ratio = 1 + change,
                     half = value_member(figure, "half");
        const char *verdict = value_text(figure, "verdict");
        if (!isfinite(change)) continue;
        html_format(to, "<tr><td>%-s</td><td class=\"n\">%f</td><td class=\"n\">%f</td>",
                    value_text(figure, "name"), value_member(figure, "a"),
                    value_member(figure, "b"));
        const int places = half > 0 && half < 0.1 ? 2 : 0;
        buffer_format(to, "<td class=\"n\">%+.*f", places, 100 * change);
        /* Student's interval is that of the logarithm; a ratio of 0 has none */
        if (!isnan(half) && ratio > 0)
            buffer_format(to, " (%+.*f to %+.*f)", places, 100 * (ratio * exp(-half / ratio) - 1),
                          places, 100 * (ratio * exp(half / ratio) - 1));
        html_format(to, "</td><td>%s</td></tr>\n",
                    strcmp(verdict, "none") ? verdict : "not told apart");
    }
    html_table_end(to);
    buffer_format(to,
                  "<p>Geometric means over %g draws, of fields L1, of values |found - exact|; the "
                  "intervals hold all of the changes with 95 %% (Student, pairs of draws).",
                  value_member(document, "draws"));
    if (json_is_object(cpu))
        buffer_format(to, " CPU time, b over a: %.3g (%.3g to %.3g).", value_member(cpu, "ratio"),
                      value_member(cpu, "low"), value_member(cpu, "high"));
    buffer_add(to, "</p>\n");
}

bool page_make_compare(struct page *page, const json_t *document)
{
    struct page_writer writer = {.alone = true};
    struct buffer *to = &writer.to;
    const json_t *sides = json_object_get(document, "sides"), *side;
    const json_t *runs[SIDES] = {0};
    size_t k;
    page_head(to, " compare");
    html_format(to,
                "<header><p class=\"kind\">sphproof compare, case %s</p><h1>%s</h1></header>\n"
                "<main>\n<section><h2>Errors</h2>\n",
                value_text(document, "case"), value_text(document, "verdict"));
    json_array_foreach(sides, k, side) {
        runs[k] = json_object_get(side, "first");
        html_format(to, "<p><b>%s</b> <code>%s</code>, n = %.0f</p>\n", value_text(side, "name"),
                    value_text(side, "of"), value_member(runs[k], "n"));
    }
    table(to, document);
    buffer_add(to, "</section>\n<section><h2>Side by side</h2>\n");
    if (value_member(document, "dim") > 1) {
        page_cloud_plots(&writer, "compare", runs, SIDES, true);
        buffer_add(to, "</div>\n");
    } else {
        lines(&writer, runs);
    }
    buffer_add(to, "</section>");
    return page_end(&writer, page);
}
