/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_plot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "map.h"
#include "picture.h"
#include "run_output.h"
#include "value.h"

enum { PLOT_POINTS_EXACT = 1001 };
static const char *const labels[FIELDS] = {"density", "velocity", "pressure", "internal energy"};

/* One field over x: particles in the window on top of the exact solution. */
struct profile {
    struct plot_series series[2];
    double *storage;
};

static bool profile_fill(struct profile *profile, const struct run_result *result, enum field field)
{
    const struct snapshot *s = &result->snapshot;
    const struct window *window = &result->problem.window;
    const double *const values[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    const size_t exact_n = PLOT_POINTS_EXACT;
    profile->storage = malloc(2 * (exact_n + s->n) * sizeof(double));
    if (!profile->storage) return false;
    double *exact_x = profile->storage, *exact_y = exact_x + exact_n, *x = exact_y + exact_n,
           *y = x + s->n;
    for (size_t i = 0; i < exact_n; i++) {
        struct problem_state state;
        exact_x[i] =
            window->lo[0] + (window->hi[0] - window->lo[0]) * (double)i / (double)(exact_n - 1);
        problem_sample(&result->problem, (double[3]){exact_x[i]}, result->time, &state);
        exact_y[i] = problem_field(&state, field);
    }
    size_t n = 0;
    for (size_t i = 0; i < s->n; i++)
        if (window_contains(window, (double[3]){s->x[0][i]})) {
            x[n] = s->x[0][i];
            y[n++] = values[field][i];
        }
    profile->series[0] = (struct plot_series){.label = "exact",
                                              .kind = PLOT_LINES,
                                              .n = exact_n,
                                              .x = exact_x,
                                              .y = exact_y,
                                              .color = PLOT_NEUTRAL};
    profile->series[1] = (struct plot_series){
        .label = "particles", .kind = PLOT_POINTS, .n = n, .x = x, .y = y, .size = 0.5};
    return true;
}

/* The first field that judges the case; every case has one. */
static enum field main_field(const struct run_settings *settings)
{
    int field = 0;
    while (!settings->file.fields[field]) field++;
    return (enum field)field;
}

/* SPH - exact at each particle of a series, malloced. NULL: no memory. */
static double *profile_errors(const struct plot_series *particles, const struct run_result *result,
                              enum field field)
{
    double *off = malloc(particles->n * sizeof *off);
    for (size_t i = 0; off && i < particles->n; i++) {
        struct problem_state state;
        problem_sample(&result->problem, (double[3]){particles->x[i]}, result->time, &state);
        off[i] = particles->y[i] - problem_field(&state, field);
    }
    return off;
}

static enum status draw_profiles(const struct run_settings *settings,
                                 const struct run_result *result, const char *path,
                                 struct movie *movie, struct error *error)
{
    struct profile profiles[FIELDS] = {0};
    struct plot_panel panels[FIELDS + 1] = {0};
    struct plot_series off = {.label = NULL};
    const struct plot_mark zero = {0, true, NULL};
    char error_label[64];
    const bool known = !result->problem.problem->fieldless;
    size_t n = 0;
    char title[256];
    enum status status = STATUS_OK;
    for (int field = 0; field < FIELDS; field++) {
        if (!settings->file.fields[field]) continue;
        if (!profile_fill(&profiles[n], result, (enum field)field)) {
            status = error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
            goto end;
        }
        panels[n] = (struct plot_panel){.x_label = "x (code units)",
                                        .y_label = labels[field],
                                        .key = n ? PLOT_KEY_NONE : PLOT_KEY_TOP,
                                        .series = profiles[n].series + (known ? 0 : 1),
                                        .series_count = known ? 2 : 1};
        n++;
    }
    if (known && n) {
        const enum field field = main_field(settings);
        const struct plot_series *particles = &profiles[0].series[1];
        if (!(off.y = profile_errors(particles, result, field))) {
            status = error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
            goto end;
        }
        off.x = particles->x, off.n = particles->n;
        off.kind = PLOT_POINTS, off.size = 0.5, off.color = 1;
        snprintf(error_label, sizeof error_label, "error of %s", labels[field]);
        panels[n++] = (struct plot_panel){.x_label = "x (code units)",
                                          .y_label = error_label,
                                          .key = PLOT_KEY_NONE,
                                          .series = &off,
                                          .series_count = 1,
                                          .marks = &zero,
                                          .mark_count = 1};
    }
    snprintf(title, sizeof title, "%s, n = %zu, t = %g%s", settings->file.title, result->n,
             result->time, known ? "" : "; no exact solution, no error");
    const struct plot plot = {
        .name = "run", .title = title, .show_title = true, .panels = panels, .panel_count = n};
    status = movie ? movie_add(movie, &plot, error) : picture_write(&plot, path, error);
end:
    for (size_t i = 0; i < FIELDS; i++) free(profiles[i].storage);
    free((void *)off.y);
    return status;
}

enum { MAPS = 3, MAP_PIXELS = 340 }; /* panels; longest side of a panel */

/* Values that the cells of a panel average, n of them: density, speed, and the error of the field
 * that judges the case (for a velocity the size of the difference); NaN outside the window, where
 * nothing is exact. */
static void map_values(const struct run_result *result, int panel, enum field field, double *values)
{
    const struct prepared *p = &result->problem;
    const struct snapshot *s = &result->snapshot;
    const double *const scalars[FIELDS] = {s->rho, NULL, s->P, s->u};
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state = {0};
        double x[3] = {0}, v[3] = {0}, square = 0;
        const bool error = panel == MAPS - 1;
        for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i], v[d] = s->v[d][i];
        if (error) problem_sample(p, x, result->time, &state);
        for (int d = 0; d < 3; d++) square += (v[d] - state.v[d]) * (v[d] - state.v[d]);
        if (panel == 0)
            values[i] = s->rho[i];
        else if (panel == 1 || field == FIELD_VELOCITY)
            values[i] = sqrt(square);
        else
            values[i] = scalars[field][i] - problem_field(&state, field);
        double in_window[3];
        problem_position(p, s, i, in_window);
        if (error && !window_contains(&p->window, in_window)) values[i] = (double)NAN;
    }
}

static void map_titles(const struct run_result *result, enum field field, char titles[MAPS][96])
{
    const int dim = result->problem.domain.dim;
    const bool vector = field == FIELD_VELOCITY;
    snprintf(titles[0], sizeof titles[0], "density [%s]", field_unit(FIELD_DENSITY, dim));
    snprintf(titles[1], sizeof titles[1], "speed |v| [%s]", field_unit(FIELD_VELOCITY, dim));
    snprintf(titles[2], sizeof titles[2], "error of %s: %s [%s]", labels[field],
             vector ? "|v - exact|" : "SPH - exact", field_unit(field, dim));
}

/* Stacks panels of wide boxes and puts others side by side. */
static void map_size(struct plot *plot, const struct map *map)
{
    const double x = map->hi[0] - map->lo[0], y = map->hi[1] - map->lo[1];
    const double scale = MAP_PIXELS / fmax(x, y);
    const int panels = (int)plot->panel_count;
    plot->beside = x <= 1.5 * y;
    if (plot->beside) {
        plot->width = panels * (int)(92 + 96 + fmax(scale * x, 150));
        plot->height = (int)(110 + scale * y);
    } else {
        plot->width = 92 + 96 + 2 * MAP_PIXELS;
        plot->height = 90 + panels * (int)(72 + 2 * scale * y);
    }
}

/* Particles over the exact curve, if the solution has one coordinate: the field that judges the
 * case, for circular flows the non-zero component of the velocity. Arrays are owned. */
struct scatter {
    struct plot_series series[2];
    char label[64];
    const char *over;
};

/* True of a flow that turns anywhere. */
static bool turns(const json_t *exact)
{
    size_t i;
    const json_t *v;
    json_array_foreach(json_object_get(exact, "azimuthal"), i, v)
        if (value_real(v) != 0) return true;
    return false;
}

/* False: there is no such curve, or no memory. */
static bool scatter_fill(struct scatter *scatter, const struct run_result *result, enum field field)
{
    static const char *const names[FIELDS] = {"density", "velocity", "pressure", "pressure"};
    json_t *profile = profile_json(result);
    const json_t *exact = json_object_get(profile, "exact");
    const char *name = names[field];
    bool there = true;
    if (field == FIELD_VELOCITY && !json_object_get(profile, name))
        name = turns(exact) ? "azimuthal" : "radial";
    const json_t *from[2] = {profile, exact};
    scatter->series[0] =
        (struct plot_series){.label = "particles", .kind = PLOT_POINTS, .size = 0.4};
    scatter->series[1] =
        (struct plot_series){.label = "exact", .kind = PLOT_LINES, .color = PLOT_NEUTRAL};
    for (int s = 0; s < 2; s++) {
        struct plot_series *one = &scatter->series[s];
        one->x = value_numbers(json_object_get(from[s], "x"), &one->n);
        one->y = value_numbers(json_object_get(from[s], name), &one->n);
        there = there && one->x && one->y; /* as many as x */
    }
    snprintf(scatter->label, sizeof scatter->label, "%s%s", name,
             name != names[field] ? " velocity" : "");
    scatter->over = !strcmp(value_text(profile, "over"), "R") ? "distance from the middle [length]"
                                                              : "x [length]";
    json_decref(profile);
    return there;
}

static bool has_void(const double *z, size_t cells)
{
    while (cells--)
        if (!isfinite(*z++)) return true;
    return false;
}

static enum status draw_maps(const struct run_settings *settings, const struct run_result *result,
                             const char *path, struct movie *movie, struct error *error)
{
    const struct snapshot *s = &result->snapshot;
    const enum field field = main_field(settings);
    const size_t panels_used = result->problem.problem->fieldless ? MAPS - 1 : MAPS;
    struct map map;
    struct plot_heat heats[MAPS];
    struct plot_panel panels[MAPS + 1];
    struct scatter scatter = {.over = ""};
    size_t panels_drawn = panels_used;
    bool voids = false;
    char titles[MAPS][96], title[400], slice[64] = "";
    if (map_create(&map, &result->problem.domain, s, MAP_CELLS, error)) return error->status;
    const size_t cells = map.nx * map.ny;
    double *values = malloc((s->n + MAPS * cells) * sizeof *values);
    if (!values) {
        map_free(&map);
        return error_set(error, STATUS_ENVIRONMENT, "--plot %.150s: no memory", path);
    }
    map_titles(result, field, titles);
    for (size_t k = 0; k < panels_used; k++) {
        double *z = values + s->n + k * cells;
        map_values(result, (int)k, field, values);
        map_mean(&map, values, z);
        voids = voids || has_void(z, cells);
        heats[k] = (struct plot_heat){.nx = map.nx,
                                      .ny = map.ny,
                                      .x = map.x,
                                      .y = map.y,
                                      .z = z,
                                      .diverging = k == MAPS - 1 && field != FIELD_VELOCITY};
        panels[k] = (struct plot_panel){.title = titles[k],
                                        .x_label = "x [length]",
                                        .y_label = "y [length]",
                                        .own_x = true,
                                        .equal = true,
                                        .x_min = map.lo[0],
                                        .x_max = map.hi[0],
                                        .y_min = map.lo[1],
                                        .y_max = map.hi[1],
                                        .key = PLOT_KEY_NONE,
                                        .heat = &heats[k]};
    }
    if (result->problem.domain.dim == 3)
        snprintf(slice, sizeof slice, ", slice z = %.3g to %.3g", map.slice[0], map.slice[1]);
    if (panels_used == MAPS && scatter_fill(&scatter, result, field))
        panels[panels_drawn++] = (struct plot_panel){.title = "particles (points) and exact (line)",
                                                     .x_label = scatter.over,
                                                     .y_label = scatter.label,
                                                     .own_x = true,
                                                     .key = PLOT_KEY_NONE,
                                                     .series = scatter.series,
                                                     .series_count = 2};
    snprintf(title, sizeof title, "%.120s, n = %zu, t = %g%s%s%s", settings->file.title, result->n,
             result->time, slice,
             voids ? "; white: outside the measure window, or no particle near" : "",
             panels_used < MAPS ? "; no exact solution, no error" : "");
    struct plot plot = {.name = "run",
                        .title = title,
                        .show_title = true,
                        .panels = panels,
                        .panel_count = panels_drawn};
    map_size(&plot, &map);
    enum status status = movie ? movie_add(movie, &plot, error) : picture_write(&plot, path, error);
    if (!status && !movie) status = picture_source(&plot, path, error);
    for (int k = 0; k < 2; k++)
        free((void *)scatter.series[k].x), free((void *)scatter.series[k].y);
    free(values);
    map_free(&map);
    return status;
}

enum status run_plot(const struct run_settings *settings, const struct run_result *result,
                     const char *path, struct movie *movie, struct error *error)
{
    return (result->problem.domain.dim == 1 ? draw_profiles : draw_maps)(settings, result, path,
                                                                         movie, error);
}
