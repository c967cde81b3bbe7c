/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "autopsy_plot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture.h"
#include "value.h"

enum { PARTS = 6, LEVELS = 64, TEXT = 240 };

/* In stacking order; each part always has the same colour. */
static const struct {
    const char *name, *label;
} parts[PARTS] = {{"disorder", "disorder"},   {"operator", "operator (gradient)"},
                  {"viscosity", "viscosity"}, {"volume", "volume elements"},
                  {"time_step", "time step"}, {"measure", "measure"}};

struct drawing {
    size_t n;                        /* number of levels */
    double x[LEVELS], whole[LEVELS]; /* particles per side, L1 of the velocity */
    double share[PARTS][LEVELS], own[PARTS][LEVELS], low[PARTS][LEVELS], high[PARTS][LEVELS];
    double order[PARTS]; /* NaN: none */
    char labels[PARTS][64], title[TEXT], sentence[2][TEXT];
    struct plot_series lines[PARTS + 1], bars[PARTS];
    struct plot_panel panels[2];
    struct plot_slope slope;
    struct plot plot;
};

/* Reads the numbers of all levels. False: there are none. */
static bool read_levels(struct drawing *d, const json_t *document)
{
    const json_t *levels = json_object_get(document, "levels"), *level, *entry;
    size_t l, i;
    for (size_t p = 0; p < PARTS; p++) d->order[p] = (double)NAN;
    json_array_foreach(levels, l, level) {
        if (d->n == LEVELS) break;
        const double n = value_member(level, "n"), spacing = value_member(level, "spacing");
        const double dim = value_member(document, "dim");
        if (!(n > 0) || !(spacing > 0) || !(dim > 0)) return false;
        d->x[d->n] = pow(n, 1 / dim);
        d->whole[d->n++] = value_member(level, "error");
    }
    json_array_foreach(json_object_get(document, "shares"), i, entry) {
        for (size_t p = 0; p < PARTS; p++) {
            const double order = value_member(entry, "order");
            if (strcmp(parts[p].name, value_text(entry, "part")) != 0) continue;
            if (isfinite(order)) d->order[p] = order;
            for (l = 0; l < d->n; l++)
                if (value_member(entry, "n") == value_member(json_array_get(levels, l), "n")) {
                    d->share[p][l] = value_member(entry, "share");
                    d->own[p][l] = value_member(entry, "error");
                }
        }
    }
    return d->n > 0;
}

/* A smaller fraction of the error is not drawn as a line. */
#define LEAST 3e-3

/* Makes the labels of the key, such as "disorder, order 1.10"; a negligible part has no order. */
static void name_parts(struct drawing *d)
{
    for (size_t p = 0; p < PARTS; p++)
        if (isfinite(d->order[p]) && d->share[p][0] > LEAST && d->share[p][d->n - 1] > LEAST)
            snprintf(d->labels[p], sizeof d->labels[p], "%s, order %.2f", parts[p].label,
                     d->order[p]);
        else
            snprintf(d->labels[p], sizeof d->labels[p], "%s", parts[p].label);
}

/* Splits the sentence into two lines, one above each panel. */
static void split_sentence(struct drawing *d, const char *text)
{
    const char *second = strstr(text, ". The largest");
    if (!second) second = strstr(text, ": it is ");
    const size_t first = second ? (size_t)(second - text) + 1 : strlen(text);
    snprintf(d->sentence[0], TEXT, "%.*s", (int)first, text);
    snprintf(d->sentence[1], TEXT, "%s", second ? second + 2 : "");
}

/* Half width of the bars, so that they do not touch. */
static double half_width(const struct drawing *d)
{
    double width = 1.06;
    for (size_t l = 1; l < d->n; l++) width = fmin(width, pow(d->x[l] / d->x[l - 1], 0.4));
    return width;
}

static void lay_out(struct drawing *d)
{
    size_t used = 0;
    double base[LEVELS] = {0}, largest = (double)NAN, least = INFINITY;
    for (size_t l = 0; l < d->n; l++) largest = fmax(largest, d->whole[l]);
    for (size_t p = 0; p < PARTS; p++) {
        bool there = false;
        for (size_t l = 0; l < d->n; l++) {
            d->low[p][l] = 100 * base[l];
            base[l] += d->share[p][l];
            d->high[p][l] = 100 * base[l];
            there |= d->share[p][l] > LEAST;
            if (!(d->share[p][l] > LEAST)) d->own[p][l] = (double)NAN;
            if (d->own[p][l] < least) least = d->own[p][l];
        }
        if (!there) continue;
        const int color = (int)p + 1;
        d->bars[used] = (struct plot_series){.kind = PLOT_BARS,
                                             .n = d->n,
                                             .x = d->x,
                                             .low = d->low[p],
                                             .high = d->high[p],
                                             .size = half_width(d),
                                             .color = color};
        d->lines[used++] = (struct plot_series){.label = d->labels[p],
                                                .kind = PLOT_LINES_POINTS,
                                                .n = d->n,
                                                .x = d->x,
                                                .y = d->own[p],
                                                .color = color};
    }
    d->lines[used] = (struct plot_series){.label = "the whole error",
                                          .kind = PLOT_LINES,
                                          .n = d->n,
                                          .x = d->x,
                                          .y = d->whole,
                                          .color = PLOT_NEUTRAL};
    const double from = d->x[0] / 1.12, to = d->x[d->n - 1] * 1.12;
    d->slope = (struct plot_slope){d->x[0], d->x[d->n - 1],
                                   3 * d->whole[d->n - 1] * pow(d->x[d->n - 1] / d->x[0], 2), -2,
                                   "second order"};
    d->panels[0] = (struct plot_panel){.title = d->sentence[0],
                                       .y_label = "L1 of the velocity",
                                       .x_log = true,
                                       .y_log = true,
                                       .x_min = from,
                                       .x_max = to,
                                       .x_ticks = d->x,
                                       .x_tick_count = d->n,
                                       .y_min = 0.7 * fmin(least, largest),
                                       .y_max = 1.5 * fmax(largest, d->slope.y0),
                                       .key = PLOT_KEY_TOP,
                                       .series = d->lines,
                                       .series_count = used + 1,
                                       .slopes = &d->slope,
                                       .slope_count = d->n > 1};
    d->panels[1] = (struct plot_panel){.title = d->sentence[1],
                                       .x_label = "particles along a side",
                                       .y_label = "shares of the error [%]",
                                       .own_x = true,
                                       .x_log = true,
                                       .x_min = from,
                                       .x_max = to,
                                       .x_ticks = d->x,
                                       .x_tick_count = d->n,
                                       .y_max = 100,
                                       .key = PLOT_KEY_NONE,
                                       .series = d->bars,
                                       .series_count = used};
}

static bool draw(struct drawing *d, const json_t *document, const char *name)
{
    enum { WIDTH = 760, HEIGHT = 560 };
    if (!read_levels(d, document)) return false;
    name_parts(d);
    split_sentence(d, value_text(document, "sentence"));
    lay_out(d);
    snprintf(d->title, TEXT, "%s: what the error of the velocity is made of",
             value_text_or(document, "title", value_text(document, "case")));
    d->plot = (struct plot){.name = name,
                            .title = d->title,
                            .show_title = true,
                            .width = WIDTH,
                            .height = HEIGHT,
                            .panels = d->panels,
                            .panel_count = 2};
    return true;
}

enum status autopsy_plot_write(const json_t *document, const char *path, struct error *error)
{
    struct drawing d = {0};
    if (!draw(&d, document, "autopsy"))
        return error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: nothing to draw", path);
    return picture_write(&d.plot, path, error);
}

void autopsy_plot_page(struct page_writer *writer, const json_t *document, const char *name)
{
    struct drawing d = {0};
    if (!draw(&d, document, name)) return;
    d.plot.show_title = false;
    d.panels[0].title = d.panels[1].title = NULL; /* the caption contains the sentence */
    page_plot(writer, &d.plot, d.title);
}
