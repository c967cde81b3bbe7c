/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_part.h"

#include <math.h>
#include <stdlib.h>

#include "value.h"

enum { POINTS = 256, CURVES = 3 };

/* Position of exact conservation on the logarithmic axes. */
static const double bottom = 1e-17;

/* A plot of time series with one panel for each curve that any run has. */
struct picture {
    const char *kind, *title, *words;
    const char *inside; /* member of "through_time"; NULL: "through_time" itself */
    const char *names[CURVES], *labels[CURVES];
};

static const struct picture pictures[] = {
    {"conservation",
     "Momentum and energy through time, against the start",
     "Change since the start, relative (momentum: to the sum of |p|; angular momentum: to that of "
     "|r x p|, about the middle of the box, which a periodic box does not conserve); 1e-17 stands "
     "for none. Round-off where the equations conserve, else the order of the steps. Masses never "
     "change.",
     NULL,
     {"momentum", "angular_momentum", "energy"},
     {"momentum error", "angular mom. error", "energy error"}},
    {"regularity",
     "How regular particles stand, through time",
     "Spread: standard deviation of the distances to nearest neighbours over their mean, 0 on a "
     "lattice, 0.52 in 2D if particles were strewn at random. Sum of gradients: rms of "
     "h |sum V grad W|, which is 0 where the gradient of a constant is. Pairs: share of particles "
     "with a neighbour nearer than half a spacing. 1e-17 stands for 0.",
     "regularity",
     {"spread", "gradient", "paired"},
     {"spread of distances", "sum of gradients", "in pairs"}},
};

struct line {
    size_t n;
    double time[POINTS], value[POINTS];
};

static bool read_line(struct line *line, const json_t *of, const char *name)
{
    line->n = value_reals(json_object_get(of, "time"), line->time, POINTS);
    const size_t n = value_reals(json_object_get(of, name), line->value, POINTS);
    if (n < line->n) line->n = n;
    for (size_t i = 0; i < POINTS; i++)
        if (line->value[i] < bottom) line->value[i] = bottom;
    return line->n > 0;
}

/* Reads a curve of each run, of at most PAGE_SCHEMES, that has it. */
static size_t read_series(const struct picture *picture, int curve, const json_t *const *runs,
                          size_t count, struct line *lines, struct plot_series *series)
{
    size_t n = 0;
    for (size_t k = 0; k < count; k++) {
        const json_t *of = json_object_get(runs[k], "through_time");
        if (picture->inside) of = json_object_get(of, picture->inside);
        if (!read_line(&lines[k], of, picture->names[curve])) continue;
        series[n++] = (struct plot_series){.label = value_text(runs[k], "label"),
                                           .kind = PLOT_LINES,
                                           .n = lines[k].n,
                                           .x = lines[k].time,
                                           .y = lines[k].value,
                                           .color = (int)k + 1};
    }
    return n;
}

static void draw(struct page_writer *writer, const struct picture *picture, const char *case_name,
                 const json_t *const *runs, size_t count)
{
    struct line *lines = page_allocate(&writer->to, (size_t)CURVES * PAGE_SCHEMES, sizeof *lines);
    struct plot_series series[CURVES][PAGE_SCHEMES];
    struct plot_panel panels[CURVES];
    size_t used = 0;
    for (int c = 0; lines && c < CURVES; c++) {
        const size_t n =
            read_series(picture, c, runs, count, lines + c * PAGE_SCHEMES, series[used]);
        if (!n) continue;
        panels[used] = (struct plot_panel){.x_label = "time t",
                                           .y_label = picture->labels[c],
                                           .y_log = true,
                                           .key = used ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                           .series = series[used],
                                           .series_count = n};
        used++;
    }
    char name[96];
    page_plot_name(name, sizeof name, case_name, picture->kind);
    const struct plot plot = {
        .name = name, .title = picture->title, .panels = panels, .panel_count = used};
    if (used) page_plot(writer, &plot, picture->words);
    free(lines);
}

void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count)
{
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++)
        draw(writer, &pictures[i], case_name, runs, count);
}
