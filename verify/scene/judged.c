/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judged.h"

#include <math.h>

static enum field main_field(const struct case_file *file)
{
    for (int f = 0; f < FIELDS; f++)
        if (file->fields[f]) return (enum field)f;
    return FIELD_DENSITY;
}

/* The components of the exact field at particle i; a scalar has one. Returns the sound speed. */
static double exact_at(const struct run_result *result, size_t i, enum field field, double value[3])
{
    const struct prepared *p = &result->problem;
    const struct snapshot *s = &result->snapshot;
    struct problem_state state;
    double x[3] = {0};
    for (int d = 0; d < p->domain.dim; d++) x[d] = s->x[d][i];
    problem_sample(p, x, result->time, &state);
    for (int d = 0; d < 3; d++) value[d] = field == FIELD_VELOCITY ? state.v[d] : 0;
    if (field != FIELD_VELOCITY) value[0] = problem_field(&state, field);
    return sqrt(p->gamma * state.P / state.rho);
}

static bool in_window(const struct run_result *result, size_t i)
{
    double place[3];
    problem_place(&result->problem, &result->snapshot, i, place);
    return window_contains(&result->problem.window, place);
}

static double signal_of(const struct run_result *result, enum field field)
{
    const struct snapshot *s = &result->snapshot;
    double mean[3] = {0}, volume = 0, distance = 0, c = 0, value[3];
    for (size_t i = 0; i < s->n; i++) {
        if (!in_window(result, i)) continue;
        c += s->volume[i] * exact_at(result, i, field, value);
        for (int d = 0; d < 3; d++) mean[d] += s->volume[i] * value[d];
        volume += s->volume[i];
    }
    for (size_t i = 0; i < s->n; i++) {
        double square = 0;
        if (!in_window(result, i)) continue;
        exact_at(result, i, field, value);
        for (int d = 0; d < 3; d++)
            square += (value[d] - mean[d] / volume) * (value[d] - mean[d] / volume);
        distance += s->volume[i] * sqrt(square);
    }
    const double scale = field == FIELD_VELOCITY ? c : fabs(mean[0]);
    return (distance > 1e-12 * scale ? distance : scale) / volume;
}

void judged_of(const struct case_file *file, const struct run_result *result, struct judged *judged)
{
    const struct problem *problem = result->problem.problem;
    const enum field field = main_field(file);
    *judged = (struct judged){"density", result->errors[FIELD_DENSITY].l1_cut, (double)NAN};
    if (result->problem.domain.dim == 1) return;
    if (!problem->fieldless) {
        const bool around = isfinite(result->azimuthal.l1);
        judged->name = around ? "azimuthal" : field_family.members[field]->name;
        judged->error = around ? result->azimuthal.l1 : result->errors[field].l1;
        judged->signal = signal_of(result, around ? FIELD_VELOCITY : field);
        return;
    }
    *judged = (struct judged){"", (double)NAN, (double)NAN};
    for (size_t i = 0; i < result->functional_count && !*judged->name; i++) {
        const double exact = result->functionals[i].exact;
        if (!isfinite(exact)) continue;
        judged->name = result->functionals[i].name;
        judged->error = fabs(result->functionals[i].value - exact);
        judged->signal = exact < 0 || exact > 0 ? fabs(exact) : 1;
    }
}
