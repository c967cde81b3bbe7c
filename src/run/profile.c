/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pages draw of a run: particles over the exact solution, and maps. */
#include "run_output.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "map.h"
#include "result.h"

/* Appends to the array of this name in an object. */
static void append(json_t *object, const char *prefix, const char *name, double value)
{
    char full[64];
    snprintf(full, sizeof full, "%s%s", prefix, name);
    json_t *array = json_object_get(object, full);
    if (!array) json_object_set_new(object, full, array = json_array());
    json_array_append_new(array, result_number(value));
}

/* ---- 1D ---- */

enum { LINE_POINTS = 1001 };

static const char *const profile_fields[] = {"density", "velocity", "pressure"};
static const enum field profile_field[] = {FIELD_DENSITY, FIELD_VELOCITY, FIELD_PRESSURE};
enum { PROFILE_FIELDS = sizeof profile_field / sizeof *profile_field };

static void sample_at(const struct run_result *result, double x, double values[FIELDS])
{
    struct problem_state state;
    problem_sample(&result->problem, (double[3]){x}, result->time, &state);
    for (int f = 0; f < FIELDS; f++) values[f] = problem_field(&state, (enum field)f);
}

/* The exact curve without points on a straight line between their neighbours. */
static json_t *exact_profile(const struct run_result *result)
{
    json_t *profile = json_object();
    const struct window *window = &result->problem.window;
    const double lo = window->lo[0], step = (window->hi[0] - lo) / (LINE_POINTS - 1);
    double kept[FIELDS], now[FIELDS], next[FIELDS];
    sample_at(result, lo, now);
    memcpy(kept, now, sizeof kept);
    for (int i = 0; i < LINE_POINTS; i++) {
        sample_at(result, lo + (i + 1) * step, next);
        bool bend = i == 0 || i == LINE_POINTS - 1;
        for (int f = 0; f < FIELDS; f++)
            bend = bend ||
                   !(fabs(next[f] - 2 * now[f] + kept[f]) <= 1e-9 * (fabs(now[f]) + fabs(next[f])));
        if (bend) {
            append(profile, "", "x", lo + i * step);
            for (int f = 0; f < PROFILE_FIELDS; f++)
                append(profile, "", profile_fields[f], now[profile_field[f]]);
        }
        memcpy(kept, now, sizeof kept);
        memcpy(now, next, sizeof now);
    }
    return profile;
}

static json_t *line_json(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    json_t *particles = json_object();
    for (size_t i = 0; i < s->n; i++) {
        double x[3];
        problem_position(&result->problem, s, i, x);
        if (!window_contains(&result->problem.window, x)) continue;
        const double value[PROFILE_FIELDS] = {s->rho[i], s->v[0][i], s->P[i]};
        double exact[FIELDS];
        sample_at(result, x[0], exact);
        append(particles, "", "x", x[0]);
        for (int f = 0; f < PROFILE_FIELDS; f++) {
            append(particles, "", profile_fields[f], value[f]);
            append(particles, "exact_", profile_fields[f], exact[profile_field[f]]);
        }
    }
    json_object_set_new(particles, "exact", exact_profile(result));
    return particles;
}

/* Sizes of a page's map and plots: particles shown, points of an exact curve, curves. */
enum { CLOUD_MAP_CELLS = 64, SHOWN = 600, EXACT_POINTS = 201, QUANTITIES = 4 };

/* ---- maps, 2D and 3D ---- */

static double speed_off(const struct snapshot *s, size_t i, int dim, const double exact[3])
{
    double square = 0;
    for (int d = 0; d < dim; d++) square += (s->v[d][i] - exact[d]) * (s->v[d][i] - exact[d]);
    return sqrt(square);
}

static void error_values(const struct run_result *result, double *values)
{
    const struct prepared *p = &result->problem;
    const struct snapshot *s = &result->snapshot;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state;
        double position[3];
        problem_sample_particle(p, s, i, &state);
        problem_position(p, s, i, position);
        values[i] = window_contains(&p->window, position) ? speed_off(s, i, p->domain.dim, state.v)
                                                          : (double)NAN;
    }
}

static json_t *map_json(const struct run_result *result)
{
    static const double none[3] = {0};
    const struct snapshot *s = &result->snapshot;
    const int dim = result->problem.domain.dim;
    struct map map;
    struct error error;
    if (map_create(&map, &result->problem.domain, s, CLOUD_MAP_CELLS, &error)) return NULL;
    const size_t cells = map.nx * map.ny;
    double *values = malloc((s->n + cells) * sizeof *values), *z = values ? values + s->n : NULL;
    json_t *object = values ? json_object() : NULL;
    if (object) {
        json_object_set_new(object, "x", result_numbers(map.x, map.nx));
        json_object_set_new(object, "y", result_numbers(map.y, map.ny));
        if (dim == 3) json_object_set_new(object, "slice", result_numbers(map.slice, 2));
        map_mean(&map, s->rho, z);
        json_object_set_new(object, "density", result_numbers(z, cells));
        for (size_t i = 0; i < s->n; i++) values[i] = speed_off(s, i, dim, none);
        map_mean(&map, values, z);
        json_object_set_new(object, "speed", result_numbers(z, cells));
        if (!result->problem.problem->fieldless) {
            error_values(result, values);
            map_mean(&map, values, z);
            json_object_set_new(object, "error", result_numbers(z, cells));
        }
    }
    free(values);
    map_free(&map);
    return object;
}

/* ---- particles over the exact curve, 2D and 3D ---- */

/* Quantities plotted against one coordinate. */
struct curve {
    const struct run_result *result;
    bool around; /* against the distance from the window's centre, else against x */
    const char *names[QUANTITIES];
};

static const struct curve over_x = {NULL, false, {"density", "velocity", "pressure", NULL}},
                          over_R = {NULL, true, {"density", "azimuthal", "radial", "pressure"}};

/* The coordinate of a position in the frame that moves with the boost. */
static double abscissa(const struct curve *curve, const double position[3])
{
    const struct prepared *p = &curve->result->problem;
    double square = 0;
    for (int d = 0; d < p->domain.dim; d++)
        square += (position[d] - p->window.centre[d]) * (position[d] - p->window.centre[d]);
    return curve->around ? sqrt(square) : position[0];
}

static void quantities(const struct curve *curve, const double position[3], double rho,
                       const double v[3], double P, double values[QUANTITIES])
{
    double azimuthal, radial;
    problem_circular(&curve->result->problem, position, v, &azimuthal, &radial);
    const double around[QUANTITIES] = {rho, azimuthal, radial, P},
                 along[QUANTITIES] = {rho, v[0], P};
    for (int q = 0; q < QUANTITIES; q++) values[q] = (curve->around ? around : along)[q];
}

static void measured(const struct curve *curve, size_t i, double *at, double values[QUANTITIES])
{
    const struct snapshot *s = &curve->result->snapshot;
    double position[3], v[3];
    problem_position(&curve->result->problem, s, i, position);
    problem_velocity(&curve->result->problem, s, i, v);
    *at = abscissa(curve, position);
    quantities(curve, position, s->rho[i], v, s->P[i], values);
}

/* Exact values at a position in the moving frame. */
static void exactly(const struct curve *curve, const double position[3], double values[QUANTITIES])
{
    const struct prepared *p = &curve->result->problem;
    struct prepared unboosted = *p;
    struct problem_state state;
    for (int d = 0; d < 3; d++) unboosted.boost[d] = 0;
    problem_sample(&unboosted, position, curve->result->time, &state);
    quantities(curve, position, state.rho, state.v, state.P, values);
}

/* Exact values at a coordinate, on the line along x through the window's centre. */
static void on_curve(const struct curve *curve, double at, double values[QUANTITIES])
{
    const struct window *window = &curve->result->problem.window;
    double position[3] = {window->centre[0], window->centre[1], window->centre[2]};
    position[0] = curve->around ? position[0] + at : at;
    exactly(curve, position, values);
}

/* True if the exact values at the particles depend only on the coordinate. */
static bool holds(const struct curve *curve)
{
    const struct snapshot *s = &curve->result->snapshot;
    const size_t step = s->n / 97 + 1;
    for (size_t i = 0; i < s->n; i += step) {
        double position[3], here[QUANTITIES], there[QUANTITIES];
        problem_position(&curve->result->problem, s, i, position);
        if (!window_contains(&curve->result->problem.window, position)) continue;
        exactly(curve, position, here);
        on_curve(curve, abscissa(curve, position), there);
        for (int q = 0; q < QUANTITIES; q++)
            if (!(fabs(here[q] - there[q]) <= 1e-9 * (1 + fabs(here[q])))) return false;
    }
    return true;
}

static void add_particles(const struct curve *curve, json_t *profile)
{
    const struct run_result *result = curve->result;
    const size_t n = result->snapshot.n;
    uint64_t chosen = 1; /* at random: lattices have rows */
    for (size_t i = 0; i < n; i++) {
        double position[3], at, values[QUANTITIES], exact[QUANTITIES];
        chosen = chosen * 6364136223846793005u + 1442695040888963407u;
        if ((double)(chosen >> 11) * 0x1p-53 * (double)n > SHOWN) continue;
        problem_position(&result->problem, &result->snapshot, i, position);
        if (!window_contains(&result->problem.window, position)) continue;
        measured(curve, i, &at, values);
        exactly(curve, position, exact);
        append(profile, "", "x", at);
        for (int q = 0; q < QUANTITIES && curve->names[q]; q++) {
            append(profile, "", curve->names[q], values[q]);
            append(profile, "exact_", curve->names[q], exact[q]);
        }
    }
}

static json_t *exact_json(const struct curve *curve)
{
    const struct window *window = &curve->result->problem.window;
    const double middle = window->centre[0], hi = window->hi[0];
    const double from = curve->around ? 0 : window->lo[0], to = curve->around ? hi - middle : hi;
    json_t *exact = json_object();
    for (int i = 0; i < EXACT_POINTS; i++) {
        /* neither at the centre, where directions are undefined, nor at an edge */
        const double at = from + (to - from) * (i + 0.5) / EXACT_POINTS;
        double values[QUANTITIES];
        on_curve(curve, at, values);
        append(exact, "", "x", at);
        for (int q = 0; q < QUANTITIES && curve->names[q]; q++)
            append(exact, "", curve->names[q], values[q]);
    }
    return exact;
}

static json_t *cloud_json(const struct run_result *result)
{
    const struct problem *problem = result->problem.problem;
    struct curve curve = problem->circular ? over_R : over_x;
    json_t *profile = json_object(), *names = json_array();
    curve.result = result;
    result_add(profile, "dim=%d map=%p", result->problem.domain.dim, (void *)map_json(result));
    for (int q = 0; q < QUANTITIES && curve.names[q]; q++)
        json_array_append_new(names, json_string(curve.names[q]));
    if (!problem->fieldless && holds(&curve)) {
        result_add(profile, "over=%s", curve.around ? "R" : "x");
        json_object_set(profile, "quantities", names);
        add_particles(&curve, profile);
        json_object_set_new(profile, "exact", exact_json(&curve));
    }
    json_decref(names);
    return profile;
}

json_t *profile_json(const struct run_result *result)
{
    return result->problem.domain.dim == 1 ? line_json(result) : cloud_json(result);
}
