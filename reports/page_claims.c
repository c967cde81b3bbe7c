/* SPDX-License-Identifier: GPL-3.0-or-later
 * Claims about schemes: the claim, the measurement, the verdict. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

enum { KERNELS = 16, STEPS = 16, DIMS = 2 };

static void claim_head(struct buffer *to, const json_t *claim)
{
    html_format(to, "<h3>%-s: %s</h3>\n<p>%s", value_text(claim, "name"),
                value_text(claim, "verdict"), value_text(claim, "claim"));
}

/* ---- pairing of particles ---- */

struct curve {
    double neighbours[STEPS], nearest[STEPS];
    struct buffer label;
};

/* Reads the mean distance to the nearest neighbour for each kernel in one dimension; curves of
 * kernels that may pair according to theory are dashed. Returns the number of curves. */
static size_t read_curves(struct buffer *to, const json_t *ladders, int dim, struct curve *curves,
                          struct plot_series *series)
{
    const json_t *ladder;
    size_t i, n = 0;
    json_array_foreach(ladders, i, ladder) {
        if (n == KERNELS || (int)value_member(ladder, "dim") != dim) continue;
        struct curve *curve = &curves[n];
        html_words(&curve->label, value_text(ladder, "kernel"));
        to->failed |= curve->label.failed;
        series[n] = (struct plot_series){
            .label = curve->label.data,
            .kind = PLOT_LINES_POINTS,
            .n = value_reals(json_object_get(ladder, "neighbours"), curve->neighbours, STEPS),
            .x = curve->neighbours,
            .y = curve->nearest,
            .color = n < PLOT_COLORS ? (int)n + 1 : PLOT_NEUTRAL,
            .dashed = !json_is_null(json_object_get(ladder, "first_negative_kh")),
            .size = 0.6};
        value_reals(json_object_get(ladder, "nearest"), curve->nearest, STEPS);
        n++;
    }
    return n;
}

static void pairing_plot(struct page_writer *writer, const json_t *claim)
{
    static const char *const titles[DIMS] = {"2D", "3D"};
    static const double ticks[] = {10, 20, 50, 100, 200, 400};
    struct curve *curves = page_allocate(&writer->to, (size_t)DIMS * KERNELS, sizeof *curves);
    struct plot_series series[DIMS][KERNELS];
    struct plot_panel panels[DIMS];
    size_t used = 0;
    for (int d = 0; curves && d < DIMS; d++) {
        const size_t n = read_curves(&writer->to, json_object_get(claim, "ladders"), d + 2,
                                     curves + d * KERNELS, series[used]);
        if (!n) continue;
        panels[used] = (struct plot_panel){.title = titles[d],
                                           .x_label = "neighbours",
                                           .y_label = "nearest [spacings]",
                                           .x_log = true,
                                           .x_ticks = ticks,
                                           .x_tick_count = sizeof ticks / sizeof *ticks,
                                           .y_min = 0,
                                           .y_max = 1.2,
                                           .key = used ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                           .series = series[used],
                                           .series_count = n};
        used++;
    }
    const struct plot plot = {.name = value_text(claim, "name"),
                              .title = "Mean distance to the nearest neighbour once particles rest",
                              .panels = panels,
                              .panel_count = used};
    if (used)
        page_plot(
            writer, &plot,
            "Kernels whose Fourier transform becomes negative are dashed. The densest lattice "
            "has 1.07 in 2D and 1.12 in 3D; near 0 all particles stand in pairs. Runs that "
            "broke down have no point.");
    for (size_t i = 0; curves && i < (size_t)DIMS * KERNELS; i++) buffer_free(&curves[i].label);
    free(curves);
}

static void most_paired(struct buffer *to, const json_t *shares)
{
    double paired[STEPS], greatest = (double)NAN;
    const size_t n = value_reals(shares, paired, STEPS);
    for (size_t i = 0; i < n; i++) greatest = fmax(greatest, paired[i]);
    buffer_format(to, "%.1f %%", 100 * greatest);
}

static const struct html_column ladders[] = {
    COLUMN("kernel", "kernel", .kind = CELL_TEXT),
    COLUMN("in", "dim", .format = "%.0fD"),
    COLUMN("#transform negative at kh", "first_negative_kh", .otherwise = "nowhere"),
    COLUMN("#pairs by theory from", "predicted", .otherwise = "never"),
    COLUMN("#most in pairs", "paired", .cell = most_paired),
    COLUMN("runs", "verdict", .kind = CELL_TEXT),
    COLUMN("see it again", "reproduce", .kind = CELL_CODE),
    {0}};

static void pairing_table(struct page_writer *writer, const json_t *claim)
{
    struct buffer *to = &writer->to;
    claim_head(to, claim);
    buffer_format(
        to,
        " Gas that starts in disorder comes to rest. A particle with a neighbour nearer than "
        "half a spacing stands in a pair; up to %g %% of the particles may. The columns of theory "
        "(Dehnen &amp; Aly 2012) say where the kernel's transform becomes negative, and from "
        "which number of neighbours on pairs have less energy than single particles.</p>\n",
        100 * value_member(claim, "bound"));
    pairing_plot(writer, claim);
    html_list(to, "runs", ladders, json_object_get(claim, "ladders"), NULL);
}

/* ---- two schemes that differ in one key ---- */

static const struct html_column sides[] = {COLUMN("both with", "label", .kind = CELL_CODE),
                                           COLUMN("figure", "figure", .kind = CELL_TEXT),
                                           COLUMN("#without", "without"),
                                           COLUMN("#with", "with"),
                                           COLUMN("verdict", "verdict", .kind = CELL_TEXT),
                                           COLUMN("see it again", "reproduce", .kind = CELL_CODE),
                                           {0}};

static void claim_table(struct buffer *to, const json_t *claim)
{
    const json_t *row;
    size_t i;
    claim_head(to, claim);
    buffer_add(to, " Errors of the figure, relative where its exact value is not 0:</p>\n");
    html_heads(to, "runs", sides);
    html_format(to,
                "<tr><td></td><td></td><td class=\"n\"><code>%s</code></td>"
                "<td class=\"n\"><code>%s</code></td><td></td><td></td></tr>\n",
                value_text(claim, "without"), value_text(claim, "with"));
    json_array_foreach(json_object_get(claim, "rows"), i, row) html_row(to, sides, row);
    html_table_end(to);
}

void page_claims(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *claim;
    size_t i;
    buffer_add(to, "<section id=\"claims\"><h2>Claims, measured</h2>\n<p>Two schemes that differ "
                   "in one key on the same problem. A claim holds in a row if it makes the error "
                   "smaller by a factor of more than 1.25. Runs are small in the quick report; the "
                   "nightly one has runs of real size.</p>\n");
    json_array_foreach(json_object_get(results, "claims"), i, claim) {
        if (json_object_get(claim, "ladders"))
            pairing_table(writer, claim);
        else
            claim_table(to, claim);
    }
    buffer_add(to, "</section>\n");
}
