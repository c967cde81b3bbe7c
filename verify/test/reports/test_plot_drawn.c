/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares scripts and data of random plots, and adapted SVG of gnuplot (some of it malformed),
 * with data/drawn/plots.txt, byte for byte. verify/test/keep renews that file. */
#include "test.h"

#include "buffer.h"
#include "drawn_document.h"
#include "script.h"

enum { PLOTS = 250, PICTURES = 200, PANELS = 3, SERIES = 4, POINTS = 12, KEPT_TOGETHER = 10 };

struct drawn {
    double values[PANELS][SERIES + 1][4][POINTS], z[PANELS][POINTS * POINTS], ticks[2];
    struct plot_series series[PANELS][SERIES];
    struct plot_slope slopes[PANELS][2];
    struct plot_mark marks[PANELS][2];
    struct plot_heat heat[PANELS];
    struct plot_panel panels[PANELS];
};

static bool toss(struct drawing *draw, size_t n)
{
    return !drawn_below(draw, n);
}

static const char *words(struct drawing *draw)
{
    static const char *const texts[] = {
        "", "x", "it's \x01 'W'", "Δ ρ ≥ 0", "a rather long name", "plain"};
    return toss(draw, 5) ? NULL : texts[drawn_below(draw, sizeof texts / sizeof *texts)];
}

/* Numbers of a magnitude that differs between panels; some are not finite, equal, or nearly so. */
static void numbers(struct drawing *draw, double *values, size_t n)
{
    static const double sizes[] = {1, 1, 1, 1e-3, 300, 1e4, 1e-9};
    const double size = sizes[drawn_below(draw, sizeof sizes / sizeof *sizes)];
    const bool flat = toss(draw, 8), odd = toss(draw, 3), below = toss(draw, 4);
    for (size_t i = 0; i < n; i++) {
        values[i] =
            size * (flat ? 1 + 1e-12 * (double)(i % 2) : drawn_real(draw) - (below ? 1 : 0));
        if (odd && toss(draw, 6)) values[i] = toss(draw, 2) ? (double)NAN : (double)INFINITY;
    }
}

/* Ascending positive numbers, evenly spaced or not. */
static void centres(struct drawing *draw, double *values, size_t n)
{
    const double step = (double)(1 + drawn_below(draw, 16)) / 4;
    const bool even = toss(draw, 2);
    values[0] = step / 2;
    for (size_t i = 1; i < n; i++) values[i] = values[i - 1] + (even ? step : step * (double)i);
}

static void draw_heat(struct drawing *draw, struct drawn *d, size_t p)
{
    struct plot_heat *heat = &d->heat[p];
    *heat = (struct plot_heat){.nx = 1 + drawn_below(draw, 4), .ny = 1 + drawn_below(draw, 4)};
    double *x = d->values[p][SERIES][0], *y = d->values[p][SERIES][1];
    centres(draw, x, heat->nx);
    centres(draw, y, heat->ny);
    numbers(draw, d->z[p], heat->nx * heat->ny);
    heat->x = x, heat->y = y, heat->z = d->z[p];
    heat->label = words(draw);
    heat->diverging = toss(draw, 4);
    if (toss(draw, 3)) heat->low = -drawn_real(draw), heat->high = drawn_real(draw);
}

static void draw_series(struct drawing *draw, struct drawn *d, size_t p, size_t k)
{
    static const double dot_sizes[] = {0, 0.5, 0.4, 1, 2};
    double(*values)[POINTS] = d->values[p][k];
    const size_t n = drawn_below(draw, POINTS + 1);
    for (int v = 0; v < 4; v++) numbers(draw, values[v], POINTS);
    d->series[p][k] = (struct plot_series){.label = words(draw),
                                           .kind = (enum plot_kind)drawn_below(draw, 5),
                                           .n = n,
                                           .x = values[0],
                                           .y = values[1],
                                           .low = values[2],
                                           .high = values[3],
                                           .color = (int)drawn_below(draw, 10) - 1,
                                           .dashed = toss(draw, 3),
                                           .size = dot_sizes[drawn_below(draw, 5)]};
    if (d->series[p][k].kind >= PLOT_BAND && toss(draw, 2)) d->series[p][k].y = NULL;
    if (d->series[p][k].color > PLOT_COLORS) d->series[p][k].color = PLOT_AUTO;
}

static void draw_plot(struct drawing *draw, struct drawn *d, struct plot *plot)
{
    const bool x_log = toss(draw, 2); /* stacked panels share their x axis */
    *d = (struct drawn){.ticks = {0.5, 200}};
    *plot = (struct plot){.name = toss(draw, 9) ? "it's" : "drawn",
                          .title = words(draw),
                          .show_title = toss(draw, 3),
                          .width = toss(draw, 3) ? 300 + (int)drawn_below(draw, 400) : 0,
                          .height = toss(draw, 3) ? 150 + (int)drawn_below(draw, 500) : 0,
                          .panels = d->panels,
                          .panel_count = 1 + drawn_below(draw, PANELS),
                          .beside = toss(draw, 4)};
    for (size_t p = 0; p < plot->panel_count; p++) {
        struct plot_panel *panel = &d->panels[p];
        *panel = (struct plot_panel){.title = words(draw),
                                     .x_label = words(draw),
                                     .y_label = words(draw),
                                     .own_x = toss(draw, 3),
                                     .equal = toss(draw, 6),
                                     .x_log = x_log,
                                     .y_log = toss(draw, 2),
                                     .key = (enum plot_key)drawn_below(draw, 3),
                                     .series = d->series[p],
                                     .series_count = drawn_below(draw, SERIES + 1),
                                     .slopes = d->slopes[p],
                                     .marks = d->marks[p],
                                     .mark_count = drawn_below(draw, 3)};
        if (toss(draw, 3)) panel->x_ticks = d->ticks, panel->x_tick_count = 2;
        if (toss(draw, 4)) panel->x_min = 0.25, panel->x_max = panel->x_min + drawn_real(draw) / 2;
        if (toss(draw, 4))
            panel->y_min = 0.125, panel->y_max = 0.125 + (double)drawn_below(draw, 200);
        if (panel->x_log && panel->y_log) panel->slope_count = drawn_below(draw, 3);
        for (size_t k = 0; k < panel->series_count; k++) draw_series(draw, d, p, k);
        for (size_t k = 0; k < panel->slope_count; k++)
            d->slopes[p][k] = (struct plot_slope){
                1 + (double)k, 16, (double)(1 + drawn_below(draw, 9)), -1 - (double)k, words(draw)};
        for (size_t k = 0; k < panel->mark_count; k++)
            d->marks[p][k] = (struct plot_mark){drawn_real(draw), toss(draw, 2), words(draw)};
        if (!panel->x_log && !panel->y_log && !toss(draw, 3))
            draw_heat(draw, d, p), panel->heat = &d->heat[p];
    }
}

TEST(scripts)
{
    struct digests kept;
    struct drawn d;
    struct plot plot;
    struct buffer text = {0};
    char *script, *data, name[64];
    digests_open(&kept, test_word(1), "plots.txt");
    for (size_t k = 0; k < PLOTS; k++) {
        struct drawing draw = {k, NULL};
        draw_plot(&draw, &d, &plot);
        assert_true(plot_source(&plot, &script, &data));
        buffer_format(&text, "%s%s", script, data);
        script_make(&text, &plot, toss(&draw, 4) ? SCRIPT_PNG : SCRIPT_SVG, NULL, NULL);
        free(script);
        free(data);
        if (k % KEPT_TOGETHER != KEPT_TOGETHER - 1) continue;
        snprintf(name, sizeof name, "plots-%zu", k / KEPT_TOGETHER);
        script = buffer_take(&text);
        digests_compare(&kept, name, script);
        free(script);
    }
    digests_close(&kept);
}

/* ---- SVG ---- */

/* A tag with attributes as in gnuplot's output, sometimes malformed. */
static void draw_tag(struct drawing *draw, struct buffer *to, const char *name)
{
    static const char *const attributes[] = {"fill='black'",
                                             "fill = \"none\"",
                                             "stroke='rgb(0,114,178)'",
                                             "stroke='rgb(213, 94, 0)'",
                                             "color='black'",
                                             "color=\"rgb(0,114,178)\"",
                                             "color='rgb(0,132,95)'",
                                             "color='white'",
                                             "color='rgb(1,2,3)'",
                                             "font-family='sans'",
                                             "class='gp'",
                                             "id='a_1'",
                                             "xlink:href='#gpPt6'",
                                             "xlink:href='#gpPt2'",
                                             "xlink:href='data:image/png;base64,AA=='",
                                             "transform='translate(10.25,20.5) scale(1.5)'",
                                             "transform='translate(1,2.26) scale(3)'",
                                             "transform='rotate(3)'",
                                             "viewBox='0 0 9 8'",
                                             "d='M1 2L3,4'",
                                             "fill='rgb(0,0000000000000000114,178)'",
                                             "fill='rgb(0,00000000000000000114,178)'",
                                             "fill='rgb(0,000000000000000000114,178)'",
                                             "fill='rgb(0,114,434)'",
                                             "href=''",
                                             "xlink:href=''"};
    static const char *const bad[] = {"fill", "fill=none", "fill='none", "a='1' b", "/"};
    size_t n = toss(draw, 60) ? 23 + drawn_below(draw, 4) : drawn_below(draw, 5);
    buffer_format(to, "<%s", name);
    for (; n > 0; n--) {
        buffer_add(to, toss(draw, 3) ? "\n\t" : " ");
        buffer_add(to, attributes[drawn_below(draw, sizeof attributes / sizeof *attributes)]);
    }
    if (toss(draw, 150)) buffer_format(to, " %s", bad[drawn_below(draw, sizeof bad / sizeof *bad)]);
}

static void draw_particles(struct drawing *draw, struct buffer *to)
{
    static const char *const colors[] = {"rgb(0,114,178)", "rgb(213,94,0)", "black"};
    for (size_t n = drawn_below(draw, 5); n > 0; n--) { /* arguments have no order */
        const size_t x = drawn_below(draw, 90), y = drawn_below(draw, 100);
        const char *size = toss(draw, 3) ? "1.5" : "0.75";
        const char *color = colors[drawn_below(draw, toss(draw, 2) ? 3 : 1)];
        buffer_format(to,
                      "<use xlink:href='#gpPt6' transform='translate(%zu.25,7.%zu) scale(%s)' "
                      "color='%s'/>\n",
                      x, y, size, color);
    }
}

static void draw_elements(struct drawing *draw, struct buffer *to, size_t depth)
{
    static const char *const leaves[] = {"path", "use", "circle", "image", "g"};
    static const char *const nodes[] = {"g",     "g",      "text",           "desc",
                                        "title", "filter", "linearGradient", "xlink:a"};
    for (size_t n = drawn_below(draw, depth ? 4 : 7); n > 0; n--) {
        const char *node = nodes[drawn_below(draw, sizeof nodes / sizeof *nodes)];
        if (toss(draw, 4)) draw_particles(draw, to);
        if (toss(draw, 3)) buffer_add(to, toss(draw, 2) ? "\n " : "text &amp; more");
        if (depth > 3 || toss(draw, 2)) {
            draw_tag(draw, to, leaves[drawn_below(draw, 4)]);
            buffer_add(to, toss(draw, 2) ? "/>" : " />\n");
            continue;
        }
        draw_tag(draw, to, node);
        buffer_add(to, ">");
        draw_elements(draw, to, depth + 1);
        if (!toss(draw, 100)) buffer_format(to, "</%s>", node);
    }
}

TEST(pictures)
{
    struct digests kept;
    struct buffer text = {0};
    char name[64];
    digests_open(&kept, test_word(1), "pictures.txt");
    for (size_t k = 0; k < PICTURES; k++) {
        struct drawing draw = {k, NULL};
        struct buffer raw = {0}, to = {0};
        if (!toss(&draw, 20)) buffer_add(&raw, "<?xml version='1.0'?>\n");
        /* groups may be nested 32 deep */
        const size_t deep = toss(&draw, 20) ? 31 + drawn_below(&draw, 3) : 0;
        draw_tag(&draw, &raw, toss(&draw, 40) ? "sgv" : "svg");
        buffer_add(&raw, ">");
        for (size_t i = 0; i < deep; i++) buffer_add(&raw, "<g>");
        if (deep) buffer_add(&raw, "x");
        for (size_t i = 0; i < deep; i++) buffer_add(&raw, "</g>");
        draw_elements(&draw, &raw, 0);
        draw_particles(&draw, &raw);
        buffer_add(&raw, toss(&draw, 20) ? "</g></svg>" : toss(&draw, 20) ? "" : "</svg>behind");
        const bool well = svg_adapt(&to, raw.data, "one", "a <b>");
        buffer_format(&text, "%d %s\n", well, to.data ? to.data : "");
        buffer_free(&raw);
        buffer_free(&to);
        if (k % KEPT_TOGETHER != KEPT_TOGETHER - 1) continue;
        snprintf(name, sizeof name, "pictures-%zu", k / KEPT_TOGETHER);
        char *all = buffer_take(&text);
        digests_compare(&kept, name, all);
        free(all);
    }
    digests_close(&kept);
}
