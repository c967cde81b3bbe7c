/* SPDX-License-Identifier: GPL-3.0-or-later
 * Colours of plots: the colour-blind-safe palette of Okabe and Ito, adjusted so that each has
 * enough contrast as text; one column for light and one for dark backgrounds. Internal to plots. */
#pragma once

/* STYLE(css class, colour on light, colour on dark): first the text colour, `currentColor` in a
 * page; then axes and grid; then the palette in order. */
#define STYLE_LIST(STYLE)                                                                          \
    STYLE(plot_ink, "#1b1f24", "#e6e8eb")                                                          \
    STYLE(plot_axis, "#8a9099", "#7d848e")                                                         \
    STYLE(plot_grid, "#e1e4e8", "#33383f")                                                         \
    STYLE(plot_1, "#0072b2", "#4db1ea")                                                            \
    STYLE(plot_2, "#d55e00", "#ff8b3d")                                                            \
    STYLE(plot_3, "#00845f", "#2dc79a")                                                            \
    STYLE(plot_4, "#b4578f", "#e08cc0")                                                            \
    STYLE(plot_5, "#b07800", "#ecb63b")                                                            \
    STYLE(plot_6, "#3a8fc4", "#8ccdf2")                                                            \
    STYLE(plot_7, "#6b5bb5", "#a99bf0")

enum style {
#define STYLE(name, light, dark) STYLE_##name,
    STYLE_LIST(STYLE)
#undef STYLE
        STYLE_COUNT
};

struct style_color {
    const char *css, *light, *dark;
};

extern const struct style_color style_colors[STYLE_COUNT];

/* Light colour for plot_series.color; next: the colour for PLOT_AUTO. */
const char *style_series(int color, int next);

/* The style sheet with the colours of inlined plots in light and dark. */
const char *style_css(void);
