/* SPDX-License-Identifier: GPL-3.0-or-later
 * The page of `sphproof judge`: verdict, gates, orders, assumptions and their reasons, errors,
 * candidate kernels, particles and the exact solution. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page.h"
#include "page_part.h"
#include "value.h"

static const char *const fields[] = {"x", "density", "velocity", "pressure"};
enum { FIELDS_READ = sizeof fields / sizeof *fields, PANELS = FIELDS_READ - 1 };

static void profiles(struct page_writer *writer, const json_t *judged, size_t number)
{
    const json_t *profile = json_object_get(judged, "profile");
    struct page_columns particles, exact;
    struct plot_series series[PANELS][2];
    struct plot_panel panels[PANELS] = {0};
    char name[64], which[32];
    const bool whole = page_columns_read(&writer->to, &particles, profile, fields, FIELDS_READ);
    if (page_columns_read(&writer->to, &exact, json_object_get(profile, "exact"), fields,
                          FIELDS_READ) &&
        whole) {
        for (int k = 0; k < PANELS; k++) {
            series[k][0] = (struct plot_series){.label = "exact",
                                                .kind = PLOT_LINES,
                                                .n = exact.n,
                                                .x = exact.of[0],
                                                .y = exact.of[k + 1],
                                                .color = PLOT_NEUTRAL};
            series[k][1] = (struct plot_series){.label = "particles",
                                                .kind = PLOT_POINTS,
                                                .n = particles.n,
                                                .x = particles.of[0],
                                                .y = particles.of[k + 1],
                                                .size = 0.5};
            panels[k] = (struct plot_panel){.x_label = "x",
                                            .y_label = fields[k + 1],
                                            .key = k ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                            .series = series[k],
                                            .series_count = 2};
        }
        snprintf(which, sizeof which, "profiles-%zu", number);
        page_plot_name(name, sizeof name, "judge", which);
        const struct plot plot = {.name = name,
                                  .title = "particles over the exact solution",
                                  .panels = panels,
                                  .panel_count = PANELS};
        page_plot(writer, &plot, "Particles in the window over the exact solution, code units.");
    }
    page_columns_free(&particles), page_columns_free(&exact);
}

/* In 2D and 3D: maps, and particles with the exact curve if there is one. */
static void cloud(struct page_writer *writer, const json_t *judged, size_t number)
{
    char which[32];
    json_t *labelled = json_copy((json_t *)judged);
    const json_t *const one[] = {labelled};
    snprintf(which, sizeof which, "judge-%zu", number);
    writer->to.failed |=
        !labelled || json_object_set_new(labelled, "label", json_string("this snapshot"));
    if (!writer->to.failed) page_cloud_plots(writer, which, one, 1, false);
    if (labelled) buffer_add(&writer->to, "</div>\n");
    json_decref(labelled);
}

static void errors(struct buffer *to, const json_t *judged)
{
    static const char *const norms[] = {"l1", "l2", "linf", "particle_mean"};
    const char *field;
    json_t *of;
    html_table(to, "errors", "field|#L1|#L2|#Linf|#mean over particles");
    json_object_foreach(json_object_get(judged, "errors"), field, of) {
        if (!json_is_object(of)) continue;
        buffer_add(to, "<tr>");
        html_cell(to, field);
        for (int k = 0; k < 4; k++) html_cell_number(to, value_member(of, norms[k]));
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
}

static const struct html_column assumptions[] = {COLUMN("what", "what", .kind = CELL_TEXT),
                                                 COLUMN("taken for", "value", .kind = CELL_TEXT),
                                                 COLUMN("because", "evidence", .kind = CELL_TEXT),
                                                 {0}},
                                candidates[] = {
                                    COLUMN("kernel", "name", .kind = CELL_TEXT),
                                    COLUMN("density as sum of", "density", .kind = CELL_TEXT),
                                    COLUMN("#support radius/h", "ratio", .kind = CELL_DIGITS),
                                    COLUMN("#density misses by", "residual"),
                                    {0}};

static void snapshot(struct page_writer *writer, const json_t *judged, size_t number)
{
    struct buffer *to = &writer->to;
    html_format(to, "<section><h2>%s</h2><p>%s</p>\n", value_text(judged, "file"),
                value_text(judged, "verdict"));
    if (json_integer_value(json_object_get(judged, "dim")) > 1)
        cloud(writer, judged, number);
    else
        profiles(writer, judged, number);
    errors(to, judged);
    buffer_add(to, "<h3>What was assumed</h3>\n");
    html_list(to, "assumptions", assumptions, json_object_get(judged, "assumptions"), NULL);
    html_format(to, "<h3>Kernel and meaning of h: the density summed again</h3><p>%s</p>\n",
                value_text(json_object_get(judged, "kernel"), "why"));
    html_list(to, "candidates", candidates,
              json_object_get(json_object_get(judged, "kernel"), "candidates"), NULL);
    buffer_add(to, "</section>\n");
}

static void allowed(struct buffer *to, const json_t *gate)
{
    html_format(to, strcmp(value_text(gate, "relation"), ">=") ? "≤ %f" : "≥ %f",
                value_member(gate, "bound"));
}

static void why(struct buffer *to, const json_t *gate)
{
    const char *why = value_text(gate, "why");
    buffer_escape(to, *why ? why : value_text(gate, "source"));
}

/* Gates of the snapshot with the most particles. */
static const struct html_column gates[] = {
    COLUMN("gate", "name", .kind = CELL_CODE), COLUMN("#found", "value"),
    COLUMN("#allowed", NULL, .cell = allowed), COLUMN("", "status", .kind = CELL_STATUS),
    COLUMN("why", NULL, .cell = why),          {0}};

static void interval(struct buffer *to, const json_t *order)
{
    if (json_is_number(json_object_get(order, "order")))
        buffer_format(to, "%.3f to %.3f", value_member(order, "low"), value_member(order, "high"));
    else
        buffer_add(to, "—");
}

static void pairwise(struct buffer *to, const json_t *list)
{
    const json_t *one;
    size_t i;
    json_array_foreach(list, i, one) buffer_format(to, "%s%.3f", i ? ", " : "", value_real(one));
}

static const struct html_column fitted[] = {
    COLUMN("L1 of", "field", .kind = CELL_WORDS),
    COLUMN("#order", "order", .format = "%.3f", .otherwise = "—", .finite = true),
    COLUMN("#95 % interval", NULL, .cell = interval),
    COLUMN("pairwise", "pairwise", .cell = pairwise),
    {0}};

/* Several snapshots have orders if their numbers of particles differ, and a drift of conserved
 * quantities if their times differ. */
static void together(struct buffer *to, const json_t *document)
{
    static const char *const kept[] = {"mass", "momentum", "angular_momentum", "energy"};
    const json_t *orders = json_object_get(document, "orders");
    const json_t *drift = json_object_get(document, "conservation");
    size_t k;
    if (json_array_size(orders)) {
        buffer_add(to, "<section id=\"orders\"><h2>Orders</h2>\n");
        html_list(to, "orders", fitted, orders, NULL);
        buffer_add(to, "</section>\n");
    } else if (json_object_get(document, "no_orders")) {
        html_format(to, "<section id=\"orders\"><h2>Orders</h2><p>None: %s.</p></section>\n",
                    value_text(document, "no_orders"));
    }
    if (!json_is_object(drift)) return;
    buffer_add(to, "<section id=\"conservation\"><h2>Conservation</h2><p>From ");
    for (k = 0; k < 2; k++) {
        const char *file = json_string_value(json_array_get(json_object_get(drift, "between"), k));
        html_format(to, k ? "%s:" : "%s to ", file ? file : "");
    }
    const char *before = " ";
    for (k = 0; k < sizeof kept / sizeof *kept; k++) {
        if (!isfinite(value_member(drift, kept[k]))) continue;
        html_format(to, "%s%-s %f", before, kept[k], value_member(drift, kept[k]));
        before = ", ";
    }
    buffer_add(to, " have changed.</p></section>\n");
}

bool page_make_judge(struct page *page, const json_t *document)
{
    struct page_writer writer = {.alone = true};
    struct buffer *to = &writer.to;
    const json_t *snapshots = json_object_get(document, "snapshots"), *one;
    size_t k;
    page_head(to, " judge");
    html_format(to,
                "<header class=\"%s\"><p class=\"kind\">sphproof judge, case %s</p><h1>%s</h1>"
                "</header>\n<main>\n",
                strcmp(value_text(document, "status"), "pass") ? "unwell" : "well",
                value_text(document, "case"), value_text(document, "headline"));
    if (json_array_size(json_object_get(document, "gates"))) {
        buffer_add(to, "<section id=\"gates\"><h2>Gates</h2>\n");
        html_list(to, "gates", gates, json_object_get(document, "gates"), NULL);
        buffer_add(to, "</section>\n");
    }
    together(to, document);
    if (json_array_size(snapshots))
        json_array_foreach(snapshots, k, one) snapshot(&writer, one, k);
    else
        snapshot(&writer, document, 0);
    return page_end(&writer, page);
}
