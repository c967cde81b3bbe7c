/* SPDX-License-Identifier: GPL-3.0-or-later
 * Computation skipped where no signal has arrived: fraction skipped, largest possible fraction,
 * time saved, and where and when particles are inactive. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

enum { NAME = 96, ROWS = 64, COLUMNS = 128, MAP_WIDTH = 330, MAP_HEIGHT = 240 };

/* The words between `sphproof bench` and the options: the case and its keys. */
static void setup_of(const json_t *document, char name[NAME])
{
    const char *from = value_text(document, "reproduce"), *bench = strstr(from, "bench ");
    snprintf(name, NAME, "%s", bench ? bench + 6 : from);
    char *options = strstr(name, " --");
    if (options) *options = '\0';
}

static const json_t *sleep_of(const json_t *document)
{
    return json_array_get(json_object_get(document, "skips"), 0);
}

static void setup_words(struct buffer *to, const json_t *document)
{
    char name[NAME];
    setup_of(document, name);
    html_format(to, "<code>%s</code>", name);
}

static void percent(struct buffer *to, const json_t *share)
{
    buffer_format(to, "%.0f %%", 100 * value_real(share));
}

static void possible(struct buffer *to, const json_t *sleep)
{
    const json_t *share = json_object_get(sleep, "possible_fraction");
    if (isfinite(value_real(share))) {
        percent(to, share);
        if (!strcmp(value_text(sleep, "possible_by"), "coarse threshold")) buffer_add(to, "*");
    } else {
        buffer_add(to, "—");
    }
}

static void time_left(struct buffer *to, const json_t *saves)
{
    buffer_format(to, "%.2f", 1 / value_real(saves));
}

#define SHARE .cell = percent, .otherwise = "—", .finite = true
static const struct html_column shares[] = {COLUMN("setup", NULL, .cell = setup_words),
                                            COLUMN("#skipped", "skips/0/skipped_fraction", SHARE),
                                            COLUMN("#allowed", "skips/0/allowed_fraction", SHARE),
                                            COLUMN("#possible", "skips/0", .cell = possible),
                                            COLUMN("#CPU time", "skips/0/saves", .cell = time_left),
                                            COLUMN("#spread", "skips/0/spread", SHARE),
                                            COLUMN("#difference", "skips/0/difference"),
                                            COLUMN("#bound", "skips/0/bound"),
                                            COLUMN("answer", "skips/0/status", .kind = CELL_STATUS),
                                            {0}};

/* Draws where (along x) and when (relative to t_end) particles are inactive. */
static void plot_map(struct page_writer *writer, const json_t *document, size_t number)
{
    static double z[ROWS * COLUMNS], x[COLUMNS], y[ROWS];
    const json_t *map = json_object_get(sleep_of(document), "asleep");
    const size_t rows = json_array_size(map), columns = json_array_size(json_array_get(map, 0));
    if (!rows || rows > ROWS || !columns || columns > COLUMNS) return;
    for (size_t c = 0; c < columns; c++) x[c] = ((double)c + 0.5) / (double)columns;
    for (size_t r = 0; r < rows; r++) {
        y[r] = ((double)r + 0.5) / (double)rows;
        if (value_reals(json_array_get(map, r), z + r * columns, columns) < columns) return;
    }
    const struct plot_heat heat = {.nx = columns,
                                   .ny = rows,
                                   .x = x,
                                   .y = y,
                                   .z = z,
                                   .label = "share asleep",
                                   .low = 0,
                                   .high = 1};
    const struct plot_panel panel = {.x_label = "x, in boxes",
                                     .y_label = "t / t_end",
                                     .x_min = 0,
                                     .x_max = 1,
                                     .y_min = 0,
                                     .y_max = 1,
                                     .key = PLOT_KEY_NONE,
                                     .heat = &heat};
    char setup[NAME], name[NAME], what[32], title[NAME + 32];
    setup_of(document, setup);
    snprintf(what, sizeof what, "asleep-%zu", number);
    page_plot_name(name, sizeof name, value_text(sleep_of(document), "case"), what);
    snprintf(title, sizeof title, "%s: share of the gas asleep", setup);
    const struct plot plot = {.name = name,
                              .title = title,
                              .width = MAP_WIDTH,
                              .height = MAP_HEIGHT,
                              .panels = &panel,
                              .panel_count = 1};
    page_plot(writer, &plot, setup);
}

void page_skips(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *skips = json_object_get(results, "skips");
    size_t i;
    const json_t *document;
    buffer_add(
        to,
        "<section id=\"skips\"><h2>What is left out where no signal has been</h2>\n<p>Particles "
        "whose rates and velocity differences are below a tolerance sleep (1e-11 in 1D, 1e-8 of "
        "the "
        "largest rate at the start in 2D and 3D): their "
        "sums are left out until a disturbance comes near. Skipped: share of the particle updates "
        "of the run. Allowed: gas that has not changed by more than the tolerance, nor stands "
        "within h of gas that has. Possible: gas further than three smoothing lengths ahead of "
        "every wave of the "
        "exact solution; with *, where that has no waves with an edge, gas that changes by less "
        "than 1e-7 in the time h/c. CPU time: that of the run with skips over that of the run "
        "without, and the larger spread of the two. Difference: the largest of any field at t_end "
        "over its largest value. Noh's inflow converges: its density grows everywhere at the rate "
        "(d - 1)/r, so that it is nowhere at rest in 2D and 3D.</p>\n");
    html_list(to, "costs", shares, skips, NULL);
    buffer_add(to, "<div class=\"figures\">");
    json_array_foreach(skips, i, document) plot_map(writer, document, i + 1);
    buffer_add(to, "</div>\n");
    json_array_foreach(skips, i, document)
        html_command(to, i ? "" : "see it again:", value_text(document, "reproduce"));
    buffer_add(to, "</section>\n");
}
