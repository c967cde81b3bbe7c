/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_time.h"

#include <math.h>
#include <stdlib.h>

#include "html.h"
#include "value.h"

enum { POINTS = 256, SUMS = 2 };

/* Axes are logarithmic: what is exactly conserved is drawn at the bottom. */
static const double bottom = 1e-17;

struct line {
    size_t n;
    double time[POINTS], drift[SUMS][POINTS];
};

static bool read_line(struct line *line, const json_t *run)
{
    static const char *const names[SUMS] = {"momentum", "energy"};
    const json_t *through = json_object_get(run, "through_time");
    line->n = value_reals(json_object_get(through, "time"), line->time, POINTS);
    for (int s = 0; s < SUMS; s++) {
        const size_t n = value_reals(json_object_get(through, names[s]), line->drift[s], POINTS);
        if (n < line->n) line->n = n;
        for (size_t i = 0; i < n; i++)
            if (line->drift[s][i] < bottom) line->drift[s][i] = bottom;
    }
    return line->n > 0;
}

void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count)
{
    static const char *const labels[SUMS] = {"momentum error", "energy error"};
    struct line *lines = calloc(PAGE_SCHEMES, sizeof *lines);
    struct plot_series series[SUMS][PAGE_SCHEMES];
    struct plot_panel panels[SUMS];
    size_t n = 0;
    for (size_t k = 0; lines && k < count && k < PAGE_SCHEMES; k++) {
        if (!read_line(&lines[k], runs[k])) continue;
        for (int s = 0; s < SUMS; s++)
            series[s][n] = (struct plot_series){.label = value_text(runs[k], "label"),
                                                .kind = PLOT_LINES,
                                                .n = lines[k].n,
                                                .x = lines[k].time,
                                                .y = lines[k].drift[s],
                                                .color = (int)k + 1};
        n++;
    }
    for (int s = 0; s < SUMS; s++)
        panels[s] = (struct plot_panel){.x_label = "time t",
                                        .y_label = labels[s],
                                        .y_log = true,
                                        .key = s ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = series[s],
                                        .series_count = n};
    char name[96];
    page_plot_name(name, sizeof name, case_name, "conservation");
    const struct plot plot = {.name = name,
                              .title = "Momentum and energy through time, against the start",
                              .panels = panels,
                              .panel_count = SUMS};
    if (n)
        page_plot(writer, &plot,
                  "Change since the start, relative (momentum: to the sum of |p|); 1e-17 stands "
                  "for none. Round-off where the equations conserve, else the order of the steps. "
                  "Masses never change.");
    free(lines);
}
