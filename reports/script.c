/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "layout.h"
#include "list.h"
#include "style.h"

/* Writes a string on one line; doubles this character. */
static void line(struct buffer *to, const char *string, char doubled)
{
    for (const char *c = string ? string : ""; *c; c++) {
        if (*c == doubled) buffer_add_bytes(to, c, 1);
        buffer_add_bytes(to, (unsigned char)*c < ' ' ? " " : c, 1);
    }
}

/* Writes a string in single quotes, in which gnuplot interprets nothing; a quote is doubled. */
static void quote(struct buffer *to, const char *string)
{
    buffer_add(to, "'");
    line(to, string, '\'');
    buffer_add(to, "'");
}

static void number(struct buffer *to, double value)
{
    if (isfinite(value))
        buffer_format(to, " %.10g", value);
    else
        buffer_add(to, " NaN");
}

/* Writes one line per row of cells, from bottom to top. */
static void heat_data(struct buffer *to, const struct plot_heat *heat)
{
    buffer_format(to, "# %zu rows of %zu cells\n", heat->ny, heat->nx);
    for (size_t j = 0; j < heat->ny; j++) {
        for (size_t i = 0; i < heat->nx; i++) {
            const double z = heat->z[j * heat->nx + i];
            if (isfinite(z))
                buffer_format(to, " %.6g", z); /* more digits than colours can show */
            else
                buffer_add(to, " NaN");
        }
        buffer_add(to, "\n");
    }
    buffer_add(to, "\n\n");
}

void script_data(struct buffer *to, const struct plot *plot)
{
    for (size_t p = 0; p < plot->panel_count; p++) {
        const struct plot_panel *panel = &plot->panels[p];
        if (panel->heat) heat_data(to, panel->heat);
        for (size_t k = 0; k < panel->series_count; k++) {
            const struct plot_series *series = &panel->series[k];
            const bool filled = series->kind == PLOT_BAND || series->kind == PLOT_BARS;
            buffer_format(to, "# x y%s: ", filled ? " low high" : "");
            line(to, series->label, '\0');
            buffer_add(to, "\n");
            for (size_t i = 0; i < series->n; i++) {
                number(to, series->x[i]);
                number(to, series->y ? series->y[i] : (double)NAN);
                if (filled) {
                    number(to, series->low[i]);
                    number(to, series->high[i]);
                }
                buffer_add(to, "\n");
            }
            if (!series->n) buffer_add(to, " NaN NaN NaN NaN\n");
            buffer_add(to, "\n\n");
        }
    }
}

static const char *superscript(char *buffer, int exponent)
{
    static const char *const digit[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    char *end = buffer;
    int size = abs(exponent), power = 1;
    if (exponent < 0) end = stpcpy(end, "⁻");
    while (size / power >= 10) power *= 10;
    for (; power; power /= 10) end = stpcpy(end, digit[size / power % 10]);
    return buffer;
}

/* Labels at decades; at 1, 2, 5 if there are few decades; as powers if numbers get long. */
static void log_ticks(struct buffer *to, const struct layout_axis *axis, const double *ticks,
                      size_t n)
{
    double decades = log10(axis->max / axis->min);
    const char *comma = "";
    buffer_add(to, " (");
    for (size_t k = 0; ticks && k < n; k++, comma = ", ")
        buffer_format(to, "%s'%.6g' %.10g", comma, ticks[k], ticks[k]);
    bool plain = axis->min >= 0.009 && axis->max <= 2e5;
    int first = (int)floor(log10(axis->min)), last = (int)ceil(log10(axis->max));
    int step = (int)fmax(1, ceil(decades / 7));
    for (int e = first; !ticks && e <= last; e++) {
        for (int m = 1; m < 10; m++) {
            double value = m * pow(10, e);
            if (value < 0.999 * axis->min || value > 1.001 * axis->max) continue;
            bool few = decades < 1.6 && (m == 2 || m == 5 || decades < 0.5);
            char power[64];
            if (m > 1 && !few && decades > 5) continue;
            buffer_format(to, "%s'", comma);
            comma = ", ";
            if (m == 1 ? e % step == 0 : few) {
                if (plain)
                    buffer_format(to, "%.6g", value);
                else if (m == 1)
                    buffer_format(to, "10%s", superscript(power, e));
                else
                    buffer_format(to, "%d·10%s", m, superscript(power, e));
            }
            buffer_format(to, "' %.10g %d", value, m == 1 || few ? 0 : 1);
        }
    }
    buffer_add(to, ")");
}

/* 1, 2 or 5 times a power of ten, so that a linear axis has at most `most` steps. */
static double tick_step(const struct layout_axis *range, double most)
{
    double rough = (range->max - range->min) / most, power = pow(10, floor(log10(rough)));
    double mantissa = rough / power;
    return power * (mantissa <= 1 ? 1 : mantissa <= 2 ? 2 : mantissa <= 5 ? 5 : 10);
}

/* pixels: length of the axis. */
static void axis(struct buffer *to, char which, const struct layout_axis *range, double pixels,
                 bool labelled, const double *ticks, size_t n)
{
    buffer_format(to, "%s logscale %c\n", range->log ? "set" : "unset", which);
    buffer_format(to, "set %crange [%.10g:%.10g]\n", which, range->min, range->max);
    buffer_format(to, "unset %ctics\nset %ctics out nomirror scale 0.6,0.3 textcolor rgb '%s'",
                  which, which, style_colors[STYLE_plot_ink].light);
    if (range->log)
        log_ticks(to, range, ticks, n);
    else
        buffer_format(to, " %.10g", tick_step(range, fmax(2, pixels / (which == 'x' ? 75 : 30))));
    buffer_format(to, "%s\nset format %c '%s'\n", which == 'x' ? " offset 0,0.4" : " offset 0.6,0",
                  which, labelled ? "%g" : "");
}

/* Axis names have fixed positions, whatever the length of the numbers. */
static void axis_names(struct buffer *to, const struct layout *layout, size_t p,
                       const struct plot_panel *panel, bool last)
{
    const struct layout_panel *at = &layout->panels[p];
    const char *ink = style_colors[STYLE_plot_ink].light;
    if (panel->y_label) {
        buffer_add(to, "set label ");
        quote(to, panel->y_label);
        buffer_format(to, " at screen %.5f, screen %.5f center rotate textcolor rgb '%s'\n",
                      (at->left - 80) / layout->width,
                      1 - (at->top + at->bottom) / 2 / layout->height, ink);
    }
    if (panel->x_label && last) {
        buffer_add(to, "set label ");
        quote(to, panel->x_label);
        buffer_format(to, " at screen %.5f, screen %.5f center textcolor rgb '%s'\n",
                      (at->left + at->right) / 2 / layout->width,
                      1 - (at->bottom + 38) / layout->height, ink);
    }
}

static void marks(struct buffer *to, const struct plot_panel *panel)
{
    const char *color = style_colors[STYLE_plot_axis].light;
    for (size_t k = 0; k < panel->mark_count; k++) {
        const struct plot_mark *mark = &panel->marks[k];
        if (mark->horizontal)
            buffer_format(to, "set arrow from graph 0, first %.10g to graph 1, first %.10g",
                          mark->at, mark->at);
        else
            buffer_format(to, "set arrow from first %.10g, graph 0 to first %.10g, graph 1",
                          mark->at, mark->at);
        buffer_format(to, " nohead dashtype (4,4) linewidth 1.2 linecolor rgb '%s'\n", color);
        if (!mark->label) continue;
        buffer_add(to, "set label ");
        quote(to, mark->label);
        if (mark->horizontal)
            buffer_format(to, " at graph 0.99, first %.10g right offset 0,0.5", mark->at);
        else
            buffer_format(to, " at first %.10g, graph 0.94 left offset 0.5,0", mark->at);
        buffer_format(to, " textcolor rgb '%s'\n", color);
    }
    for (size_t k = 0; k < panel->slope_count; k++) {
        const struct plot_slope *slope = &panel->slopes[k];
        double y1 = slope->y0 * pow(slope->x1 / slope->x0, slope->order);
        buffer_format(to,
                      "set arrow from %.10g, %.10g to %.10g, %.10g nohead dashtype (6,4) linewidth "
                      "1.2 linecolor rgb '%s'\n",
                      slope->x0, slope->y0, slope->x1, y1, color);
        if (!slope->label) continue;
        buffer_add(to, "set label ");
        quote(to, slope->label);
        buffer_format(to, " at %.10g, %.10g right offset -0.6,-0.1 textcolor rgb '%s'\n", slope->x1,
                      y1, color);
    }
}

static void end_labels(struct buffer *to, const struct layout *layout, size_t p,
                       const struct plot_panel *panel)
{
    double pixels[panel->series_count ? panel->series_count : 1];
    layout_ends(&layout->panels[p], panel, pixels);
    int next = 0;
    for (size_t k = 0; k < panel->series_count; k++) {
        const struct plot_series *series = &panel->series[k];
        if (series->color == PLOT_AUTO) next++;
        if (isnan(pixels[k])) continue;
        buffer_add(to, "set label ");
        quote(to, series->label);
        buffer_format(to, " at screen %.5f, screen %.5f left textcolor rgb '%s'\n",
                      (layout->panels[p].right + 9) / layout->width, 1 - pixels[k] / layout->height,
                      style_series(series->color, next));
    }
}

/* viridis, five stops: uniform in lightness, so that it works in grey. */
static const char *const viridis =
    "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n";

/* Blue, white, red: 0 is white; uniform in lightness on both sides. */
static const char *const blue_to_red =
    "set palette defined (0 '#2166ac', 1 '#92c5de', 2 '#f7f7f7', 3 '#f4a582', 4 '#b2182b')\n";

static const char *const next_curve = ", \\\n  ";

static void heat(struct buffer *to, const struct plot_heat *heat, const char *data, size_t index)
{
    const double dx =
        heat->nx > 1 ? (heat->x[heat->nx - 1] - heat->x[0]) / ((double)heat->nx - 1) : 1;
    const double dy =
        heat->ny > 1 ? (heat->y[heat->ny - 1] - heat->y[0]) / ((double)heat->ny - 1) : 1;
    buffer_format(to,
                  "%s index %zu matrix using (%.10g + %.10g*$1):(%.10g + %.10g*$2):3 with image "
                  "notitle",
                  data, index, heat->x[0], dx, heat->y[0], dy);
}

static void curve(struct buffer *to, const struct plot_series *series, const char *data,
                  size_t index, int next, bool named)
{
    static const int shapes[] = {7, 9, 5, 13, 11, 6, 8};
    const char *color = style_series(series->color, next);
    const int number = series->color > 0 ? series->color - 1 : next > 0 ? next - 1 : 0;
    int shape = shapes[(size_t)number % (sizeof shapes / sizeof *shapes)];
    double size = series->size > 0 ? series->size : 1;
    if (size < 1) shape = shapes[0]; /* particles: dots, which svg.c combines */
    double width = series->color == PLOT_NEUTRAL ? 1.4 : 2;
    const char *dash = series->dashed ? "(8,5)" : "solid";
    buffer_format(to, "%s index %zu ", data, index);
    switch (series->kind) {
    case PLOT_LINES:
        buffer_format(to, "using 1:2 with lines linewidth %g dashtype %s", width, dash);
        break;
    case PLOT_POINTS:
        buffer_format(to, "using 1:2 with points pointtype %d pointsize %g", shape, 0.7 * size);
        break;
    case PLOT_LINES_POINTS:
        buffer_format(to,
                      "using 1:2 with linespoints linewidth %g dashtype %s pointtype %d "
                      "pointsize %g",
                      width, dash, shape, 0.7 * size);
        break;
    case PLOT_BAND:
        buffer_add(to, "using 1:3:4 with filledcurves fillstyle transparent solid 0.22 noborder");
        break;
    case PLOT_BARS:
        buffer_format(to,
                      "using 1:3:($1/%g):($1*%g):3:4 with boxxyerror fillstyle solid 0.85 noborder",
                      size, size);
        break;
    }
    buffer_format(to, " linecolor rgb '%s' ", color);
    bool dots = series->kind == PLOT_POINTS && size < 1; /* too small for the key */
    if (dots && named && series->label)
        buffer_format(to, "notitle%sNaN with points pointtype %d pointsize 0.8 linecolor rgb '%s' ",
                      next_curve, shape, color);
    if (named && series->label) {
        buffer_add(to, "title ");
        quote(to, series->label);
    } else {
        buffer_add(to, "notitle");
    }
}

/* Ticks of a colour bar of this height; on a low bar their distance follows from the height of the
 * labels. */
static void color_ticks(struct buffer *to, double low, double high, double pixels)
{
    const double label = 1.5 * LAYOUT_FONT, least = (high - low) / fmax(1, floor(pixels / label));
    if (pixels > 8 * label || !(least > 0 && isfinite(least))) return;
    const double ten = pow(10, floor(log10(least))), part = least / ten;
    buffer_format(to, "set cbtics %.10g\n", ten * (part <= 2 ? 2 : part <= 5 ? 5 : 10));
}

/* The bar is 14 pixels wide, as high as the panel. */
static void color_scale(struct buffer *to, const struct plot_heat *heat,
                        const struct layout *layout, const struct layout_panel *at)
{
    const char *ink = style_colors[STYLE_plot_ink].light;
    double low = (double)INFINITY, high = -(double)INFINITY;
    list_range(heat->z, heat->nx * heat->ny, &low, &high);
    if (heat->diverging) high = fmax(-low, high), low = -high;
    if (heat->high > heat->low) low = heat->low, high = heat->high;
    buffer_add(to, heat->diverging ? blue_to_red : viridis);
    if (heat->high > heat->low || (heat->diverging && high > 0))
        buffer_format(to, "set cbrange [%.10g:%.10g]\n", low, high);
    else
        buffer_add(to, "set cbrange [*:*]\n");
    buffer_add(to, "set cblabel ");
    quote(to, heat->label);
    buffer_format(to,
                  " textcolor rgb '%s'\nset colorbox user origin screen %.5f, screen %.5f size "
                  "screen %.5f, screen %.5f noborder\nset cbtics textcolor rgb '%s'\nset cbtics "
                  "autofreq\n",
                  ink, (at->right + 12) / layout->width, 1 - at->bottom / layout->height,
                  14.0 / layout->width, (at->bottom - at->top) / layout->height, ink);
    if (!heat->diverging) color_ticks(to, low, high, at->bottom - at->top);
}

static void panel_script(struct buffer *to, const struct plot *plot, const struct layout *layout,
                         size_t p, const char *data, size_t *index)
{
    const struct plot_panel *panel = &plot->panels[p];
    const struct layout_panel *at = &layout->panels[p];
    bool last = plot->beside || p + 1 == plot->panel_count || panel[1].own_x; /* in its stack */
    const char *ink = style_colors[STYLE_plot_ink].light;
    buffer_add(to, "\nunset arrow\nunset label\n");
    buffer_format(to, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n",
                  at->left / layout->width, at->right / layout->width);
    buffer_format(to, "set tmargin at screen %.5f\nset bmargin at screen %.5f\n",
                  1 - at->top / layout->height, 1 - at->bottom / layout->height);
    axis(to, 'x', &at->x, at->right - at->left, last, panel->x_ticks, panel->x_tick_count);
    axis(to, 'y', &at->y, at->bottom - at->top, true, NULL, 0);
    axis_names(to, layout, p, panel, last);
    marks(to, panel);
    if (panel->title) {
        buffer_add(to, "set label ");
        quote(to, panel->title);
        buffer_format(to, " at graph 0, graph 1 left offset 0,0.7 textcolor rgb '%s'\n", ink);
    }
    if (p == 0 && plot->show_title && plot->title) {
        buffer_add(to, "set label ");
        quote(to, plot->title);
        buffer_format(to, " at screen %.5f, screen %.5f left textcolor rgb '%s'\n",
                      layout->left / layout->width, 1 - 16.0 / layout->height, ink);
    }
    if (p == 0 && layout->key_rows)
        buffer_format(
            to,
            "set key at screen %.5f, screen %.5f left top horizontal Left reverse samplen "
            "1.6 maxcols %d textcolor rgb '%s' noenhanced\n",
            (layout->left - 14) / layout->width,
            1 - (plot->show_title ? 28.0 : 4.0) / layout->height, layout->key_columns, ink);
    else
        buffer_add(to, "unset key\n");
    if (panel->key == PLOT_KEY_END) end_labels(to, layout, p, panel);
    if (panel->heat) color_scale(to, panel->heat, layout, at);
    buffer_add(to, "plot ");
    if (panel->heat) heat(to, panel->heat, data, (*index)++);
    int next = 0;
    for (size_t k = 0; k < panel->series_count; k++) {
        if (panel->series[k].color == PLOT_AUTO) next++;
        if (k || panel->heat) buffer_add(to, next_curve);
        curve(to, &panel->series[k], data, (*index)++, next, panel->key == PLOT_KEY_TOP);
    }
    if (!panel->heat && !panel->series_count) buffer_add(to, "NaN notitle");
    buffer_add(to, "\n");
}

void script_make(struct buffer *to, const struct plot *plot, enum script_terminal terminal,
                 const char *output, const char *data)
{
    struct layout layout;
    layout_make(&layout, plot);
    buffer_add(to, "# ");
    line(to, plot->title, '\0');
    buffer_add(to, "\n");
    if (terminal == SCRIPT_SVG)
        buffer_format(to, "set terminal svg size %d,%d dynamic noenhanced font 'sans-serif,%d'\n",
                      layout.width, layout.height, LAYOUT_FONT);
    else
        buffer_format(to,
                      "set terminal pngcairo size %d,%d noenhanced font 'sans,%g' linewidth 2 "
                      "pointscale 2 background '#ffffff'\n",
                      2 * layout.width, 2 * layout.height, 1.5 * LAYOUT_FONT);
    if (output) {
        buffer_add(to, "set output ");
        quote(to, output);
        buffer_add(to, "\n");
    }
    buffer_add(to, "set encoding utf8\n");
    if (!data) {
        data = "$data";
        buffer_add(to, "$data << END_OF_DATA\n");
        script_data(to, plot);
        buffer_add(to, "END_OF_DATA\n");
    }
    buffer_format(to,
                  "set border 3 linecolor rgb '%s'\n"
                  "set grid ytics linetype 1 dashtype solid linewidth 0.7 linecolor rgb '%s'\n",
                  style_colors[STYLE_plot_axis].light, style_colors[STYLE_plot_grid].light);
    if (plot->panel_count > 1) buffer_add(to, "set multiplot\n");
    size_t index = 0;
    for (size_t p = 0; p < plot->panel_count; p++) panel_script(to, plot, &layout, p, data, &index);
    if (plot->panel_count > 1) buffer_add(to, "unset multiplot\n");
}
