/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plots by gnuplot through a pipe, all in one style: colour-blind-safe, light and dark. Input:
 * plain arrays, owned by the caller; output: a picture in memory, which the caller writes to a
 * file. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "process.h"

enum plot_status {
    PLOT_OK,
    PLOT_NO_GNUPLOT, /* gnuplot is not installed or hangs; do not try again */
    PLOT_FAILED,     /* gnuplot failed, or no memory */
};

enum plot_kind {
    PLOT_LINES,
    PLOT_POINTS,
    PLOT_LINES_POINTS,
    PLOT_BAND, /* filled between low and high; y unused */
    PLOT_BARS  /* filled between low and high, a bar at each x, from x/size to x*size */
};

enum { PLOT_AUTO = 0, PLOT_NEUTRAL = -1 }; /* colours: automatic, text colour, or 1..PLOT_COLORS */
enum { PLOT_COLORS = 7 };

struct plot_series {
    const char *label; /* NULL: unnamed */
    enum plot_kind kind;
    size_t n;
    const double *x, *y;      /* a non-finite value interrupts a line */
    const double *low, *high; /* bands and bars only */
    int color;                /* PLOT_AUTO: next of the palette */
    bool dashed;
    double size; /* size of points, 0: the default of 1; profiles of many particles use less */
};

/* Reference slope: y = y0 (x/x0)^order from x0 to x1, dashed, labelled (log-log panels). */
struct plot_slope {
    double x0, x1, y0, order;
    const char *label;
};

/* A line across the panel at x = at, or at y = at if horizontal. */
struct plot_mark {
    double at;
    bool horizontal;
    const char *label; /* or NULL */
};

/* Heat map on linear axes: cell (i, j) is centred at x[i], y[j] and has the value z[j * nx + i];
 * NaN cells are empty. */
struct plot_heat {
    size_t nx, ny;
    const double *x, *y, *z;
    const char *label; /* of the colour scale, with unit */
    bool diverging;    /* the middle of the colours is 0, with the same range for both signs */
    double low, high;  /* of the colour scale; equal: from the data */
};

enum plot_key {
    PLOT_KEY_TOP, /* one key above the first panel */
    PLOT_KEY_END, /* each curve is labelled at its right end */
    PLOT_KEY_NONE
};

struct plot_panel {
    const char *title;             /* or NULL */
    const char *x_label, *y_label; /* with units; a stack has the x_label of its last panel */
    bool own_x;                    /* begins a new stack with its own x axis */
    bool equal;                    /* equal scales on both axes */
    bool x_log, y_log;
    double x_min, x_max, y_min, y_max; /* min == max: from the data */
    const double *x_ticks;             /* positions of labels on log axes; NULL: automatic */
    size_t x_tick_count;
    enum plot_key key;
    const struct plot_series *series;
    size_t series_count;
    const struct plot_slope *slopes;
    size_t slope_count;
    const struct plot_mark *marks;
    size_t mark_count;
    const struct plot_heat *heat; /* or NULL */
};

struct plot {
    const char *name;  /* letters, digits, '_' and '-': prefix of ids, name of saved files */
    const char *title; /* one line, a text alternative; also drawn if `show_title` */
    bool show_title;
    int width, height; /* pixels; 0: 560, and from the number of panels */
    const struct plot_panel
        *panels; /* stacked from top to bottom; two or more share their x axis (see own_x) */
    size_t panel_count;
    bool beside; /* panels from left to right, each with its own axes */
};

/* A running gnuplot that draws one plot after another, since starting gnuplot takes several times
 * as long as drawing. Starts as {0}: not running. Each plot starts from gnuplot's default state,
 * and a failed plot does not affect others. */
struct plot_pen {
    struct process gnuplot;
    int script; /* an unnamed file, also open in gnuplot; -1: none */
    bool begun;
};
void plot_pen_free(struct plot_pen *pen);

/* An <svg> element for inlining in HTML (no prolog, ids prefixed with the plot's name, colours by
 * the classes of style_css). *svg is malloced; NULL on failure, with the reason in message (n
 * bytes). pen: NULL for a separate gnuplot. */
enum plot_status plot_svg(struct plot_pen *pen, const struct plot *plot, char **svg, char *message,
                          size_t n);

enum plot_format { PLOT_SVG, PLOT_PNG };

/* A standalone picture of size bytes, malloced. On failure *bytes is NULL. */
enum plot_status plot_draw(const struct plot *plot, enum plot_format format, char **bytes,
                           size_t *size, char *message, size_t n);

/* The source of the plot: `gnuplot NAME.gp` next to NAME.dat makes NAME.svg. Both are malloced;
 * false: no memory. */
bool plot_source(const struct plot *plot, char **script, char **data);
