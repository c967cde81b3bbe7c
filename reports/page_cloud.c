/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_part.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "list.h"
#include "value.h"

enum { MAPS = 3, QUANTITIES = 4, MAP_PIXELS = 300 };

/* ---- maps ---- */

/* Arrays of a map, owned. */
struct map {
    size_t nx, ny, cells;
    double *x, *y, *z[MAPS];
};

static const char *const map_names[MAPS] = {"density", "speed", "error"};
static const char *const titles[MAPS] = {"density", "speed |v|", "error |v − exact v|"};

static void read_map(struct buffer *to, struct map *map, const json_t *run)
{
    const json_t *from = json_object_get(json_object_get(run, "profile"), "map");
    map->x = page_numbers(to, json_object_get(from, "x"), &map->nx);
    map->y = page_numbers(to, json_object_get(from, "y"), &map->ny);
    map->cells = map->nx * map->ny;
    for (int k = 0; k < MAPS; k++) {
        size_t n;
        map->z[k] = page_numbers(to, json_object_get(from, map_names[k]), &n);
        if (n == map->cells) continue;
        free(map->z[k]);
        map->z[k] = NULL;
    }
}

static void free_map(struct map *map)
{
    free(map->x);
    free(map->y);
    for (int k = 0; k < MAPS; k++) free(map->z[k]);
}

/* Position of an edge of the box, half a cell beyond the first or last centre. */
static double edge(const double *centres, size_t n, bool upper)
{
    const double half = n > 1 ? (centres[1] - centres[0]) / 2 : 0.5;
    return upper ? centres[n - 1] + half : centres[0] - half;
}

/* Draws one map as a separate figure, so that maps are placed side by side if there is space. The
 * figure is named after the case and `what`. */
static void plot_map(struct page_writer *writer, const char *case_name, const char *what,
                     const struct map *map, const struct plot_heat *heat, const char *title,
                     const char *caption)
{
    const double x = edge(map->x, map->nx, true) - edge(map->x, map->nx, false);
    const double y = edge(map->y, map->ny, true) - edge(map->y, map->ny, false);
    const double scale = MAP_PIXELS / fmax(x, y);
    const struct plot_panel panel = {.title = title,
                                     .x_label = "x",
                                     .y_label = "y",
                                     .equal = true,
                                     .key = PLOT_KEY_NONE,
                                     .heat = heat};
    char name[96];
    page_plot_name(name, sizeof name, case_name, what);
    const struct plot plot = {.name = name,
                              .title = title,
                              .panels = &panel,
                              .panel_count = 1,
                              .width = 188 + (int)fmax(scale * x, 150),
                              .height = 84 + (int)(scale * y)};
    page_plot(writer, &plot, caption);
}

static struct plot_heat heat_of(const struct map *map, int k)
{
    return (struct plot_heat){
        .nx = map->nx, .ny = map->ny, .x = map->x, .y = map->y, .z = map->z[k]};
}

static bool has_voids(const struct map *map, int k)
{
    for (size_t c = 0; c < map->cells; c++)
        if (!isfinite(map->z[k][c])) return true;
    return false;
}

/* Draws density, speed and error of the first scheme. */
static void plot_first(struct page_writer *writer, const char *case_name, const json_t *run,
                       const struct map *map)
{
    char what[32], slice[96] = "", caption[256];
    const json_t *z = html_member(run, "profile/map/slice");
    if (json_array_size(z) == 2)
        snprintf(slice, sizeof slice, " in the slice z = %.3g to %.3g",
                 value_real(json_array_get(z, 0)), value_real(json_array_get(z, 1)));
    buffer_add(&writer->to, "<div class=\"maps\">\n");
    for (int k = 0; k < MAPS; k++) {
        if (!map->z[k]) continue;
        const struct plot_heat heat = heat_of(map, k);
        snprintf(what, sizeof what, "map-%s", map_names[k]);
        snprintf(caption, sizeof caption,
                 "%s, n = %.0f, t = %.3g: means over the particles of each cell%s.%s",
                 value_text(run, "label"), value_member(run, "n"), value_member(run, "time"), slice,
                 has_voids(map, k) ? k == 2 ? " White: no particles, or outside the measure window."
                                            : " White: no particle is near."
                                   : "");
        plot_map(writer, case_name, what, map, &heat, titles[k], caption);
    }
    buffer_add(&writer->to, "</div>\n");
}

/* Draws map k of every scheme on the same colour scale. */
static void plot_each(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      const struct map *maps, size_t count, int k)
{
    double low = (double)INFINITY, high = -(double)INFINITY;
    size_t n = 0;
    for (size_t r = 0; r < count; r++) {
        n += maps[r].z[k] != NULL;
        list_range(maps[r].z[k], maps[r].cells, &low, &high);
    }
    if (n < 2) return;
    buffer_format(&writer->to,
                  "<h4>The %s of each scheme</h4><p class=\"note\">With the same number of "
                  "particles, on one colour scale.</p><div class=\"maps\">\n",
                  titles[k]);
    for (size_t r = 0; r < count; r++) {
        char what[32];
        if (!maps[r].z[k]) continue;
        struct plot_heat heat = heat_of(&maps[r], k);
        heat.low = low, heat.high = high;
        snprintf(what, sizeof what, "scheme-%s-%zu", map_names[k], r + 1);
        plot_map(writer, case_name, what, &maps[r], &heat, value_text(runs[r], "label"),
                 value_text(runs[r], "label"));
    }
    buffer_add(&writer->to, "</div>\n");
}

/* ---- particles and the exact curve ---- */

struct curves {
    size_t quantities;
    const char *names[1 + QUANTITIES]; /* "x" and the quantities */
    struct page_columns particles, exact;
};

static void read_curves(struct buffer *to, struct curves *curves, const json_t *run)
{
    const json_t *profile = json_object_get(run, "profile"), *name;
    size_t i, count = 1;
    curves->names[0] = "x";
    json_array_foreach(json_object_get(profile, "quantities"), i, name) {
        if (i == QUANTITIES || !json_is_string(name)) break;
        curves->names[count++] = json_string_value(name);
    }
    curves->quantities = count - 1;
    page_columns_read(to, &curves->particles, profile, curves->names, count);
    page_columns_read(to, &curves->exact, json_object_get(profile, "exact"), curves->names, count);
}

static const char *quantity_label(const char *name)
{
    static const char *const labels[][2] = {
        {"azimuthal", "azimuthal v"}, {"radial", "radial v"}, {"velocity", "v along x"}};
    for (size_t k = 0; k < sizeof labels / sizeof *labels; k++)
        if (!strcmp(labels[k][0], name)) return labels[k][1];
    return name;
}

static void plot_profiles(struct page_writer *writer, const char *case_name,
                          const json_t *const *runs, const struct curves *curves, size_t count)
{
    const struct curves *first = &curves[0];
    struct plot_series series[QUANTITIES][PAGE_SCHEMES + 1];
    struct plot_panel panels[QUANTITIES];
    const bool around = !strcmp(value_text(json_object_get(runs[0], "profile"), "over"), "R");
    for (size_t q = 0; q < first->quantities; q++) {
        size_t n = 0;
        for (size_t k = count; k-- > 0;) { /* draws the first one last, on top */
            if (curves[k].quantities != first->quantities) continue;
            series[q][n++] = (struct plot_series){.label = value_text(runs[k], "label"),
                                                  .kind = PLOT_POINTS,
                                                  .n = curves[k].particles.n,
                                                  .x = curves[k].particles.of[0],
                                                  .y = curves[k].particles.of[q + 1],
                                                  .color = (int)k + 1,
                                                  .size = 0.4};
        }
        series[q][n++] = (struct plot_series){.label = "exact",
                                              .kind = PLOT_LINES,
                                              .n = first->exact.n,
                                              .x = first->exact.of[0],
                                              .y = first->exact.of[q + 1],
                                              .color = PLOT_NEUTRAL};
        panels[q] =
            (struct plot_panel){.x_label = around ? "distance R from the middle" : "position x",
                                .y_label = quantity_label(first->names[q + 1]),
                                .key = q ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                .series = series[q],
                                .series_count = n};
    }
    char name[96];
    page_plot_name(name, sizeof name, case_name, "profiles");
    const struct plot plot = {.name = name,
                              .title = "Particles over the exact solution",
                              .panels = panels,
                              .panel_count = first->quantities};
    page_plot(writer, &plot,
              "Each point is a particle (of many only some are drawn), the line is the exact "
              "solution: the width of a cloud of points is noise, its distance from the line is "
              "what the scheme has changed.");
}

void page_cloud_plots(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      size_t count, bool all_maps)
{
    struct map *maps = page_allocate(&writer->to, count, sizeof *maps);
    struct curves *curves = page_allocate(&writer->to, count, sizeof *curves);
    if (maps && curves) {
        for (size_t r = 0; r < count; r++) {
            read_map(&writer->to, &maps[r], runs[r]);
            read_curves(&writer->to, &curves[r], runs[r]);
        }
        const int chosen = maps[0].z[MAPS - 1] ? MAPS - 1 : 0;
        if (maps[0].cells && !all_maps) plot_first(writer, case_name, runs[0], &maps[0]);
        for (int k = 0; maps[0].cells && k < MAPS; k++)
            if (all_maps || k == chosen) plot_each(writer, case_name, runs, maps, count, k);
        buffer_add(&writer->to, "<div class=\"figures\">\n");
        if (curves[0].quantities) plot_profiles(writer, case_name, runs, curves, count);
    }
    for (size_t r = 0; maps && curves && r < count; r++) {
        free_map(&maps[r]);
        page_columns_free(&curves[r].particles), page_columns_free(&curves[r].exact);
    }
    free(maps);
    free(curves);
}

/* ---- tables ---- */

static const struct html_column run_columns[] = {
    COLUMN("scheme", "label", .kind = CELL_TEXT),
    COLUMN("#n", "n"),
    COLUMN("#L1 density", "errors/density/l1", .optional = true),
    COLUMN("#L1 velocity", "errors/velocity/l1", .optional = true),
    COLUMN("#L1 azimuthal", "errors/azimuthal/l1", .optional = true),
    COLUMN("#L1 radial", "errors/radial/l1", .optional = true),
    COLUMN("#L1 pressure", "errors/pressure/l1", .optional = true),
    COLUMN("#L1 internal energy", "errors/internal_energy/l1", .optional = true),
    COLUMN("#momentum", "conservation/momentum"),
    COLUMN("#angular momentum", "conservation/angular_momentum"),
    COLUMN("#energy", "conservation/energy"),
    COLUMN("#steps", "cost/steps"),
    COLUMN("#CPU s", "cost/cpu_s"),
    COLUMN("", "status", .kind = CELL_STATUS),
    {0}};

static void run_table(struct buffer *to, const json_t *const *runs, size_t count)
{
    html_lists(to, "runs", run_columns, runs, count, NULL);
    buffer_add(to, "<p class=\"note\">L1 of the velocity: of the vector's difference. Momentum, "
                   "angular momentum, energy: what has changed since the start, relative (angular "
                   "momentum is not conserved where the box is periodic, nor by the gradients ia "
                   "and corrected).</p>\n");
}

static const struct html_column functionals[] = {
    COLUMN("scheme", "^label", .kind = CELL_TEXT),
    COLUMN("scalar", "name", .kind = CELL_WORDS),
    COLUMN("#value", "value", .otherwise = "—", .finite = true),
    COLUMN("#exact or reference", "reference", .otherwise = "—", .finite = true),
    {0}};

static void gate_status(struct buffer *to, const json_t *gate)
{
    const char *why = value_text_or(gate, "known", value_text(gate, "why"));
    html_status(to, value_text(gate, "status"));
    html_format(to, *why ? ": %s" : "%s", why);
}

static const struct html_column gates[] = {COLUMN("scheme", "^label", .kind = CELL_TEXT),
                                           COLUMN("error", "name", .kind = CELL_WORDS),
                                           COLUMN("#of this run", "value"),
                                           COLUMN("#allowed", "bound"),
                                           COLUMN("", NULL, .cell = gate_status),
                                           {0}};

/* Writes the gates of these runs; the section is open if one fails. */
static void gate_table(struct buffer *to, const json_t *const *runs, size_t count)
{
    size_t i, all = 0;
    const json_t *gate;
    bool failed = false;
    for (size_t k = 0; k < count; k++)
        json_array_foreach(json_object_get(runs[k], "gates"), i, gate) {
            failed = failed || !strcmp(value_text(gate, "status"), "fail");
            all++;
        }
    if (!all) return;
    buffer_format(to, "<details%s><summary>What these runs have to keep</summary>\n",
                  failed ? " open=\"open\"" : "");
    html_lists(to, "gates", gates, runs, count, "gates");
    buffer_add(to, "</details>\n");
}

void page_cloud_tables(struct buffer *to, const json_t *const *runs, size_t count)
{
    buffer_add(to, "<h4>Errors, conservation and cost of the runs above</h4>\n");
    run_table(to, runs, count);
    if (json_array_size(json_object_get(runs[0], "functionals")))
        html_lists(to, "functionals", functionals, runs, count, "functionals");
    gate_table(to, runs, count);
}
