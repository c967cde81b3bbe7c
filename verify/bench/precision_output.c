/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "precision.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"
#include "result.h"
#include "run_output.h"

static double merit_of(const struct precision_scheme *scheme)
{
    return scheme->count && isfinite(scheme->merit) ? scheme->merit : (double)INFINITY;
}

static int by_merit(const void *a, const void *b)
{
    const struct precision_scheme *const *x = a, *const *y = b;
    const double p = merit_of(*x), q = merit_of(*y);
    return p < q ? -1 : p > q ? 1 : *x < *y ? -1 : *x > *y;
}

static int by_cost(const void *a, const void *b)
{
    const struct precision_point *const *x = a, *const *y = b;
    const double p = (*x)->time.cpu_s, q = (*y)->time.cpu_s;
    return p < q ? -1 : p > q ? 1 : *x < *y ? -1 : *x > *y;
}

/* Pointers to all schemes, best first; the caller frees. */
static const struct precision_scheme **sorted_schemes(const struct precision *precision)
{
    const struct precision_scheme **list = malloc((precision->scheme_count + 1) * sizeof *list);
    for (size_t i = 0; list && i < precision->scheme_count; i++) list[i] = &precision->schemes[i];
    if (list) qsort(list, precision->scheme_count, sizeof *list, by_merit);
    return list;
}

/* The table has the best schemes and the references. */
enum { ROWS_MAX = 40 };

static bool shown(const struct precision_scheme *scheme, size_t rank)
{
    return scheme->count && (rank < ROWS_MAX || scheme->reference);
}

static void print_schemes(const struct precision *precision, const struct precision_scheme **list,
                          const struct table_style *style)
{
    size_t width = 24, hidden = 0;
    for (size_t i = 0; i < precision->scheme_count; i++)
        if (shown(list[i], i) && strlen(list[i]->brief) > width) width = strlen(list[i]->brief);
    printf("%s%-*s %7s %11s %8s %4s %10s %7s %11s %11s %9s%s\n", style->bold, (int)width, "scheme",
           "n", "error", "", "+-", "CPU s", "spread", "pairs", "merit", "gain", style->end);
    for (size_t i = 0; i < precision->scheme_count; i++) {
        const struct precision_scheme *scheme = list[i];
        if (!shown(scheme, i)) {
            hidden += scheme->count ? 1u : 0u;
            continue;
        }
        const struct precision_point *p = &precision->points[scheme->first + scheme->count - 1];
        char spread[8] = "-"; /* of a single run */
        if (!isnan(p->error_spread))
            snprintf(spread, sizeof spread, "%.0f%%", 100 * p->error_spread);
        printf("%-*s %7zu %11.4e %7.3f%% %4s %10.3e %6.0f%% %11.3e %11.3e %9.3g\n", (int)width,
               scheme->brief, p->n, p->error, 100 * p->relative, spread, p->time.cpu_s,
               100 * p->time.spread, p->pairs, scheme->merit, scheme->gain);
    }
    if (hidden) printf("... and %zu more (all of them: --json)\n", hidden);
    printf(
        "%sat the finest n, best first. error: of %s, absolute and of the signal %.6g (the "
        "exact one's mean distance from\nits mean; of a scalar or a uniform field its size, of a "
        "uniform velocity the sound speed);\n+-: its deviation over neighbouring n, of which it "
        "is the mean; CPU s: least of %d samples, all threads;\nspread: their median above it; "
        "merit: error^(%d/p) x CPU s, which does not depend on n at the case's order "
        "p = %d;\ngain: that of %s over the scheme's%s\n",
        style->faint, precision->error_of, precision->signal, precision->points[0].time.samples,
        precision->dim + 1, precision->order,
        precision->dim > 1 ? "SPH as textbooks have it"
                           : "the seed program's corrected method in plain C",
        style->end);
    for (size_t i = 0; i < precision->scheme_count; i++)
        if (!list[i]->count) printf("excluded: %s: %s\n", list[i]->label, list[i]->excluded);
}

static void print_front(const struct precision *precision, const struct table_style *style)
{
    const struct precision_point **list = malloc((precision->point_count + 1) * sizeof *list);
    size_t n = 0;
    for (size_t i = 0; list && i < precision->point_count; i++)
        if (precision->points[i].on_front) list[n++] = &precision->points[i];
    if (list) qsort(list, n, sizeof *list, by_cost);
    printf("\n%sPareto front: no other scheme is both cheaper and better; methods compared with "
           "take no "
           "part%s\n",
           style->bold, style->end);
    for (size_t i = 0; i < n; i++)
        printf("  %10.3e CPU s  error %10.4e  n = %-7zu %s\n", list[i]->time.cpu_s, list[i]->error,
               list[i]->n, precision->schemes[list[i]->scheme].brief);
    free(list);
}

static void print_ways(const struct precision *precision, const struct table_style *style)
{
    printf("\n%scheapest way to%s\n", style->bold, style->end);
    for (size_t t = 0; t < PRECISION_TARGETS; t++) {
        const struct precision_way *way = &precision->cheapest[t];
        printf("  %4.1f %% of the signal (%.2e): ", 100 * precision_target(precision, t),
               way->error);
        if (isfinite(way->cpu_s))
            printf("%.3e CPU s, %s\n", way->cpu_s, precision->schemes[way->scheme].label);
        else
            printf("no scheme gets there with this --n\n");
    }
}

void precision_print(const struct precision *precision, const struct table_style *style)
{
    const struct precision_scheme **list = sorted_schemes(precision);
    if (!list) return;
    printf("%s%s%s: %s, t = %g: what an error costs\n", style->bold, precision->settings->file.name,
           style->end, precision->settings->file.title,
           settings_real(&precision->points[0].settings, SETTING_t_end));
    print_schemes(precision, list, style);
    print_front(precision, style);
    print_ways(precision, style);
    free(list);
}

/* --- the plot --------------------------------------------------------------------------------- */

static bool touches_front(const struct precision *precision, const struct precision_scheme *scheme)
{
    for (size_t i = 0; i < scheme->count; i++)
        if (precision->points[scheme->first + i].on_front) return true;
    return false;
}

/* The curves to be named: the references, then the best of those on the front, then others. */
static size_t choose(const struct precision *precision, const struct precision_scheme **list,
                     const struct precision_scheme *chosen[PLOT_COLORS])
{
    size_t n = 0;
    for (int round = 0; round < 3; round++)
        for (size_t i = 0; i < precision->scheme_count && n < PLOT_COLORS; i++) {
            const int rank = list[i]->reference ? 0 : touches_front(precision, list[i]) ? 1 : 2;
            if (list[i]->count && rank == round) chosen[n++] = list[i];
        }
    return n;
}

/* What is drawn: the named schemes' points joined, all others faint. */
struct picture {
    const char *error_of;
    const struct precision_scheme *chosen[PLOT_COLORS];
    size_t curves, count, mark_count;
    struct plot_series series[PLOT_COLORS + 1];
    struct plot_mark marks[PRECISION_TARGETS];
    char names[PRECISION_TARGETS][16];
    double *x, *y; /* CPU time, percent: of all points, then of the others */
};

static bool is_named(const struct picture *picture, const struct precision_scheme *scheme)
{
    for (size_t c = 0; c < picture->curves; c++)
        if (picture->chosen[c] == scheme) return true;
    return false;
}

static void add_points(struct picture *picture, const struct precision *precision)
{
    const size_t n = precision->point_count;
    double *x = picture->x, *y = picture->y;
    size_t rest = n;
    for (size_t i = 0; i < n; i++) {
        const struct precision_point *point = &precision->points[i];
        x[i] = point->time.cpu_s;
        y[i] = 100 * point->relative;
        if (is_named(picture, &precision->schemes[point->scheme])) continue;
        x[rest] = x[i];
        y[rest++] = y[i];
    }
    if (rest > n)
        picture->series[picture->count++] = (struct plot_series){.kind = PLOT_POINTS,
                                                                 .n = rest - n,
                                                                 .x = x + n,
                                                                 .y = y + n,
                                                                 .color = PLOT_NEUTRAL,
                                                                 .size = 0.25};
    for (size_t c = 0; c < picture->curves; c++) {
        const struct precision_scheme *scheme = picture->chosen[c];
        picture->series[picture->count++] =
            (struct plot_series){.label = scheme->brief,
                                 .kind = PLOT_LINES_POINTS,
                                 .n = scheme->count,
                                 .x = x + scheme->first,
                                 .y = y + scheme->first,
                                 .dashed = scheme->reference != REFERENCE_NONE};
    }
}

/* Marks the targets that are not far below the smallest error. */
static void add_marks(struct picture *picture, const struct precision *precision, size_t points)
{
    for (size_t t = 0; t < PRECISION_TARGETS; t++) {
        const double percent = 100 * precision_target(precision, t);
        if (percent < 0.5 * gsl_stats_min(picture->y, 1, points)) continue;
        snprintf(picture->names[t], sizeof picture->names[t], "%g %%", percent);
        picture->marks[picture->mark_count++] =
            (struct plot_mark){.at = percent, .horizontal = true, .label = picture->names[t]};
    }
}

static enum status draw(const struct picture *picture, const char *case_title, const char *path,
                        struct error *error)
{
    size_t longest = 0; /* names stand right of the panel */
    for (size_t c = 0; c < picture->curves; c++)
        if (strlen(picture->chosen[c]->brief) > longest)
            longest = strlen(picture->chosen[c]->brief);
    char title[256], label[96];
    snprintf(title, sizeof title, "%.200s: what an error costs", case_title);
    snprintf(label, sizeof label, "error of %.40s (%% of the signal)", picture->error_of);
    const struct plot_panel panel = {.x_label = "CPU time (s)",
                                     .y_label = label,
                                     .x_log = true,
                                     .y_log = true,
                                     .key = PLOT_KEY_END,
                                     .series = picture->series,
                                     .series_count = picture->count,
                                     .marks = picture->marks,
                                     .mark_count = picture->mark_count};
    const struct plot plot = {.name = "bench",
                              .title = title,
                              .show_title = true,
                              .width = 560 + 8 * (int)longest,
                              .height = 480,
                              .panels = &panel,
                              .panel_count = 1};
    return picture_write(&plot, path, error);
}

enum status precision_plot(const struct precision *precision, const char *path, struct error *error)
{
    const size_t n = precision->point_count;
    const struct precision_scheme **list = sorted_schemes(precision);
    struct picture picture = {.error_of = precision->error_of,
                              .x = malloc((4 * n + 1) * sizeof(double))};
    enum status status = STATUS_OK;
    if (!list || !picture.x) {
        status = error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
    } else {
        picture.y = picture.x + 2 * n;
        picture.curves = choose(precision, list, picture.chosen);
        add_points(&picture, precision);
        add_marks(&picture, precision, n);
        status = draw(&picture, precision->settings->file.title, path, error);
    }
    free(list), free(picture.x);
    return status;
}

static json_t *point_json(const struct precision *precision, const struct precision_point *point)
{
    static const char *const references[] = {"", "graded", "seed", "seed_plain"};
    const struct precision_scheme *scheme = &precision->schemes[point->scheme];
    json_t *item = result_object(
        "scheme=%s settings=%p n=%zu error=%g error_over_signal=%g error_spread=%g? wall_s=%g "
        "cpu_s=%g spread=%g samples=%d pair_interactions=%g? figure_of_merit=%g on_front=%d?",
        scheme->label, (void *)settings_json(&point->settings), point->n, point->error,
        point->relative, point->error_spread, point->time.wall_s, point->time.cpu_s,
        point->time.spread, point->time.samples, point->pairs,
        precision_merit(precision, point->error, point->time.cpu_s), point->on_front);
    if (scheme->reference) result_add(item, "reference=%s", references[scheme->reference]);
    return item;
}

void precision_add_json(const struct precision *precision, json_t *document)
{
    json_t *points = json_array(), *schemes = json_array(), *ways = json_array(),
           *excluded = json_array();
    for (size_t i = 0; i < precision->point_count; i++)
        json_array_append_new(points, point_json(precision, &precision->points[i]));
    for (size_t i = 0; i < precision->scheme_count; i++) {
        const struct precision_scheme *scheme = &precision->schemes[i];
        if (!scheme->count)
            json_array_append_new(
                excluded, result_object("scheme=%s reason=%s", scheme->label, scheme->excluded));
        else
            json_array_append_new(
                schemes, result_object("scheme=%s figure_of_merit=%g seed_plain_over_this=%g",
                                       scheme->label, scheme->merit, scheme->gain));
    }
    for (size_t t = 0; t < PRECISION_TARGETS; t++) {
        const struct precision_way *way = &precision->cheapest[t];
        const bool reached = isfinite(way->cpu_s);
        json_array_append_new(
            ways,
            result_object("target=%g error=%g cpu_s=%p scheme=%p", precision_target(precision, t),
                          way->error, (void *)(reached ? result_number(way->cpu_s) : json_null()),
                          (void *)(reached ? json_string(precision->schemes[way->scheme].label)
                                           : json_null())));
    }
    result_add(document, "case=%s title=%s mean_density=%g signal=%g dimension=%d error_of=%s",
               precision->settings->file.name, precision->settings->file.title,
               precision->mean_density, precision->signal, precision->dim, precision->error_of);
    result_add(document, "expected_order=%d points=%p schemes=%p cheapest=%p excluded=%p",
               precision->order, (void *)points, (void *)schemes, (void *)ways, (void *)excluded);
}
