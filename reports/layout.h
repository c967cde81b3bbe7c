/* SPDX-License-Identifier: GPL-3.0-or-later
 * Layout of a plot: sizes in pixels, ranges of the data, ticks. Internal to plots. */
#pragma once

#include "plot.h"

struct layout_axis {
    bool log;
    double min, max;
};

struct layout_panel {
    struct layout_axis x, y;
    double left, right; /* pixels from the left edge of the picture */
    double top, bottom; /* pixels from its top edge */
};

enum { LAYOUT_PANELS = 8, LAYOUT_FONT = 14 };

struct layout {
    int width, height;
    double left, right; /* pixels: left edge of the first panel and right edge of the last */
    int key_columns, key_rows;
    struct layout_panel panels[LAYOUT_PANELS];
};

/* At most LAYOUT_PANELS panels. */
void layout_make(struct layout *layout, const struct plot *plot);

/* Positions of the labels at the ends of the curves: pixels[k] for series k, moved apart if they
 * would overlap; NaN for a series without a label. */
void layout_ends(const struct layout_panel *at, const struct plot_panel *panel, double *pixels);
