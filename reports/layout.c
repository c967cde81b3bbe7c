/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "layout.h"

#include <math.h>
#include <string.h>

enum { LINE = 19, KEY_SAMPLE = 55, STACK_GAP = 36, BEFORE_PANEL = 92 };
static const double LETTER = 7.7;      /* mean width of a 14 px character */
static const double KEY_LETTER = 10.0; /* width that gnuplot reserves for a character in the key */

/* Characters, not bytes, of a UTF-8 string. */
static size_t letters(const char *string)
{
    size_t n = 0;
    for (; string && *string; string++) n += ((unsigned char)*string & 0xc0) != 0x80;
    return n;
}

/* True if the axis can show the value. Beyond 1e99 the margin of a logarithmic axis would
 * overflow. */
static bool shows(const struct layout_axis *axis, double value)
{
    return axis->log ? value > 1e-99 && value < 1e99 : isfinite(value);
}

static void include(struct layout_axis *axis, double value)
{
    if (!shows(axis, value)) return;
    if (value < axis->min) axis->min = value;
    if (value > axis->max) axis->max = value;
}

static void include_all(struct layout_axis *axis, const double *values, size_t n)
{
    for (size_t i = 0; values && i < n; i++) include(axis, values[i]);
}

/* Includes the cells of a heat map, up to half a cell beyond the first and the last centre. */
static void include_cells(struct layout_axis *axis, const double *centres, size_t n)
{
    include(axis, centres[0] - (n > 1 ? centres[1] - centres[0] : 1) / 2);
    include(axis, centres[n - 1] + (n > 1 ? centres[n - 1] - centres[n - 2] : 1) / 2);
}

/* Smallest relative difference visible in a plot, or in a script whose limits have ten digits. */
static const double one_value = 1e-8;

/* Sets the range as asked if the axis can show it, else to that of the data with a margin, with a
 * default for missing or constant data. */
static void finish(struct layout_axis *axis, double min, double max, double air)
{
    if (min < max && shows(axis, min) && shows(axis, max)) {
        axis->min = min;
        axis->max = max;
        return;
    }
    if (!(axis->min <= axis->max)) {
        axis->min = axis->log ? 0.1 : 0;
        axis->max = axis->log ? 10 : 1;
    }
    if (axis->log) {
        double span = log(axis->max / axis->min);
        double by = exp(span > one_value ? air * span : 0.5);
        axis->min /= by;
        axis->max *= by;
    } else {
        double span = axis->max - axis->min;
        double size = fmax(fabs(axis->min), fabs(axis->max));
        double by = span > one_value * size ? air * span : 0.5 * fmax(size, 1e-300);
        axis->min -= by;
        axis->max += by;
    }
}

static void ranges(struct layout_panel *at, const struct plot_panel *panel)
{
    at->x = (struct layout_axis){panel->x_log, INFINITY, -INFINITY};
    at->y = (struct layout_axis){panel->y_log, INFINITY, -INFINITY};
    for (size_t k = 0; k < panel->series_count; k++) {
        const struct plot_series *series = &panel->series[k];
        const bool filled = series->kind == PLOT_BAND || series->kind == PLOT_BARS;
        include_all(&at->x, series->x, series->n);
        if (!filled)
            include_all(&at->y, series->y, series->n);
        else {
            include_all(&at->y, series->low, series->n);
            include_all(&at->y, series->high, series->n);
        }
    }
    for (size_t k = 0; k < panel->slope_count; k++) {
        const struct plot_slope *slope = &panel->slopes[k];
        include(&at->y, slope->y0);
        include(&at->y, slope->y0 * pow(slope->x1 / slope->x0, slope->order));
    }
    for (size_t k = 0; k < panel->mark_count; k++)
        include(panel->marks[k].horizontal ? &at->y : &at->x, panel->marks[k].at);
    if (panel->heat) {
        include_cells(&at->x, panel->heat->x, panel->heat->nx);
        include_cells(&at->y, panel->heat->y, panel->heat->ny);
    }
    double air = panel->heat ? 0 : 0.04;
    finish(&at->x, panel->x_min, panel->x_max, panel->x_log ? air : 0);
    finish(&at->y, panel->y_min, panel->y_max, air);
}

/* Shrinks a panel at its right or bottom until the scales of both axes are equal. */
static void equalise(struct layout_panel *at)
{
    const double x = at->x.max - at->x.min, y = at->y.max - at->y.min;
    const double scale = fmin((at->right - at->left) / x, (at->bottom - at->top) / y);
    at->right = at->left + scale * x;
    at->bottom = at->top + scale * y;
}

/* Width needed at the right for labels at the ends of curves. */
static double end_width(const struct plot_panel *panel)
{
    size_t longest = 0;
    for (size_t k = 0; panel->key == PLOT_KEY_END && k < panel->series_count; k++) {
        size_t n = letters(panel->series[k].label);
        if (n > longest) longest = n;
    }
    return longest ? 12 + LETTER * (double)longest : 0;
}

static void key(struct layout *layout, const struct plot_panel *panel)
{
    size_t count = 0, longest = 0;
    for (size_t k = 0; k < panel->series_count; k++) {
        size_t n = letters(panel->series[k].label);
        count += n > 0;
        if (n > longest) longest = n;
    }
    if (panel->key != PLOT_KEY_TOP || !count) return;
    double column = KEY_SAMPLE + KEY_LETTER * (double)longest;
    layout->key_columns = (int)fmax(1, floor((layout->right - layout->left) / column));
    layout->key_rows = ((int)count + layout->key_columns - 1) / layout->key_columns;
}

void layout_make(struct layout *layout, const struct plot *plot)
{
    size_t n = plot->panel_count;
    layout->width = plot->width ? plot->width : 560;
    layout->height = plot->height ? plot->height : n == 1 ? 350 : 90 + 165 * (int)n;
    layout->left = BEFORE_PANEL;
    double room = 18;
    for (size_t k = 0; k < n; k++) {
        const struct plot_panel *panel = &plot->panels[k];
        room = fmax(room, end_width(panel));
        if (panel->heat) room = fmax(room, 96);
    }
    layout->right = layout->width - room;
    layout->key_columns = layout->key_rows = 0;
    key(layout, &plot->panels[0]);

    double top = 12 + LINE * layout->key_rows + (plot->show_title ? LINE + 8 : 0);
    double bottom = layout->height - 50;
    double gap = 14;
    double stacks = 0;
    for (size_t k = 1; k < n; k++) stacks += plot->panels[k].own_x;
    double each = (bottom - top - gap * ((double)n - 1) - STACK_GAP * stacks) / (double)n;
    for (size_t k = 0; k < n; k++) {
        struct layout_panel *at = &layout->panels[k];
        if (plot->beside) {
            const double slot = (double)layout->width / (double)n;
            at->left = slot * (double)k + BEFORE_PANEL;
            at->right = slot * (double)(k + 1) - room;
            at->top = top + (plot->panels[k].title ? LINE : 0);
            at->bottom = bottom;
        } else {
            if (k > 0) top += each + gap + (plot->panels[k].own_x ? STACK_GAP : 0);
            at->left = layout->left;
            at->right = layout->right;
            at->top = top + (plot->panels[k].title ? LINE : 0);
            at->bottom = top + each;
        }
        ranges(at, &plot->panels[k]);
        if (plot->panels[k].equal) equalise(at);
    }
    /* a stack shares the widest x axis: the last panel gets it, then those above */
    for (size_t k = 1; k < n && !plot->beside; k++) {
        const struct layout_axis *above = &layout->panels[k - 1].x;
        struct layout_axis *x = &layout->panels[k].x;
        if (plot->panels[k].own_x) continue;
        x->min = fmin(x->min, above->min);
        x->max = fmax(x->max, above->max);
    }
    for (size_t k = n; k-- > 1 && !plot->beside;)
        if (!plot->panels[k].own_x) layout->panels[k - 1].x = layout->panels[k].x;
}

/* Pixel of a value, clipped to the panel. */
static double y_of(const struct layout_panel *panel, double value)
{
    const struct layout_axis *y = &panel->y;
    double part = y->log ? log(fmax(value, 1e-300) / y->min) / log(y->max / y->min)
                         : (value - y->min) / (y->max - y->min);
    return panel->bottom - fmin(1, fmax(0, part)) * (panel->bottom - panel->top);
}

void layout_ends(const struct layout_panel *at, const struct plot_panel *panel, double *pixels)
{
    size_t n = panel->series_count;
    for (size_t k = 0; k < n; k++) {
        const struct plot_series *series = &panel->series[k];
        pixels[k] = NAN;
        for (size_t i = 0; series->label && series->kind < PLOT_BAND && i < series->n; i++)
            if (isfinite(series->y[i]) && series->x[i] <= at->x.max)
                pixels[k] = y_of(at, series->y[i]);
    }
    /* Labels that overlap push each other apart. There are few labels, so that many small steps are
     * cheap. */
    for (int round = 0; round < 200; round++) {
        bool moved = false;
        for (size_t a = 0; a < n; a++) {
            for (size_t b = a + 1; b < n; b++) {
                double apart = pixels[b] - pixels[a];
                if (!(fabs(apart) < LINE - 2)) continue; /* far enough, or NaN */
                double push = 0.51 * (LINE - 2 - fabs(apart));
                pixels[a] += apart >= 0 ? -push : push;
                pixels[b] += apart >= 0 ? push : -push;
                moved = true;
            }
        }
        if (!moved) break;
    }
}
