/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "result.h"

enum { EXACT_POINTS = 1001 };

static const char *const profile_fields[] = {"density", "velocity", "pressure"};
static const enum field profile_field[] = {FIELD_DENSITY, FIELD_VELOCITY, FIELD_PRESSURE};
enum { PROFILE_FIELDS = sizeof profile_field / sizeof *profile_field };

static void append(json_t *object, const char *name, double value)
{
    json_t *array = json_object_get(object, name);
    if (!array) {
        array = json_array();
        json_object_set_new(object, name, array);
    }
    json_array_append_new(array, result_number(value));
}

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
    const double lo = window->lo[0], step = (window->hi[0] - lo) / (EXACT_POINTS - 1);
    double kept[FIELDS], now[FIELDS], next[FIELDS];
    sample_at(result, lo, now);
    memcpy(kept, now, sizeof kept);
    for (int i = 0; i < EXACT_POINTS; i++) {
        sample_at(result, lo + (i + 1) * step, next);
        bool bend = i == 0 || i == EXACT_POINTS - 1;
        for (int f = 0; f < FIELDS; f++)
            bend = bend ||
                   !(fabs(next[f] - 2 * now[f] + kept[f]) <= 1e-9 * (fabs(now[f]) + fabs(next[f])));
        if (bend) {
            append(profile, "x", lo + i * step);
            for (int f = 0; f < PROFILE_FIELDS; f++)
                append(profile, profile_fields[f], now[profile_field[f]]);
        }
        memcpy(kept, now, sizeof kept);
        memcpy(now, next, sizeof now);
    }
    return profile;
}

json_t *profile_json(const struct run_result *result)
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
        append(particles, "x", x[0]);
        for (int f = 0; f < PROFILE_FIELDS; f++) {
            char name[64];
            snprintf(name, sizeof name, "exact_%s", profile_fields[f]);
            append(particles, profile_fields[f], value[f]);
            append(particles, name, exact[profile_field[f]]);
        }
    }
    json_object_set_new(particles, "exact", exact_profile(result));
    return particles;
}
