/* SPDX-License-Identifier: GPL-3.0-or-later
 * The colours of plots: Okabe and Ito's colour-blind-safe palette, shifted a little so that each
 * has enough contrast as text; one column for light paper, one for dark. Internal to plots. */
#pragma once

/* STYLE(css class, colour on light, colour on dark): the first is the text colour, `currentColor`
 * in a page; then axes and grid; then the palette in order. */
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

/* Light colour of plot_series.color (`next`: what PLOT_AUTO stands for here). */
const char *style_series(int color, int next);

/* The style sheet that gives inlined plots their colours in light and dark. */
const char *style_css(void);
