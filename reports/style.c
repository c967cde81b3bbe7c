/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "style.h"

#include "plot.h"

const struct style_color style_colors[STYLE_COUNT] = {
#define STYLE(name, light, dark) {#name, light, dark},
    STYLE_LIST(STYLE)
#undef STYLE
};

const char *style_series(int color, int next)
{
    if (color == PLOT_NEUTRAL) return style_colors[STYLE_plot_ink].light;
    if (color == PLOT_AUTO) color = next;
    return style_colors[STYLE_plot_1 + (color - 1) % PLOT_COLORS].light;
}

const char *style_css(void)
{
#define STYLE(name, light, dark) "." #name "{color:" light "}"
    return "svg.plot{color:#1b1f24;font-family:system-ui,-apple-system,'Segoe UI',Helvetica,Arial,"
           "sans-serif}" STYLE_LIST(STYLE)
#undef STYLE
#define STYLE(name, light, dark) "." #name "{color:" dark "}"
               "@media screen and (prefers-color-scheme:dark){svg.plot{color:#e6e8eb}" STYLE_LIST(
                   STYLE) "}";
#undef STYLE
}
