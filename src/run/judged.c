/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "judged.h"

#include <math.h>
#include <string.h>

#include "problem_list.h"

static bool has_gate(const struct case_file *file, int field)
{
    for (size_t i = 0; i < file->gate_count; i++)
        if (!file->gates[i].functional && (int)file->gates[i].field == field) return true;
    return false;
}

size_t judged_names(const struct case_file *file, size_t functional_count,
                    const char *const *functionals, const double *exact,
                    const char *names[JUDGED_MAX])
{
    const struct problem *problem = problem_of(&file->settings);
    size_t n = 0;
    if (problem->circular == CIRCULAR_ROUND && file->dimension > 1) {
        names[n++] = "azimuthal";
        names[n++] = "radial";
    }
    for (int gated = 1; gated >= 0 && !problem->fieldless; gated--)
        for (int f = 0; f < FIELDS; f++)
            if (file->fields[f] && problem_knows(problem, (enum field)f) &&
                has_gate(file, f) == gated)
                names[n++] = field_family.members[f]->name;
    for (size_t i = 0; i < functional_count && problem->fieldless; i++)
        if (isfinite(exact[i])) names[n++] = functionals[i];
    return n;
}

size_t judged_names_of(const struct case_file *file, const struct run_result *result,
                       const char *names[JUDGED_MAX])
{
    const char *functionals[PROBLEM_FUNCTIONALS_MAX];
    double exact[PROBLEM_FUNCTIONALS_MAX];
    for (size_t i = 0; i < result->functional_count; i++) {
        functionals[i] = result->functionals[i].name;
        exact[i] = result->functionals[i].exact;
    }
    return judged_names(file, result->functional_count, functionals, exact, names);
}

/* The components of the exact field at particle i, one for a scalar. Returns the sound speed. */
static double exact_at(const struct run_result *result, size_t i, enum field field, double value[3])
{
    struct problem_state state;
    problem_sample_particle(&result->problem, &result->snapshot, i, &state);
    for (int d = 0; d < 3; d++) value[d] = field == FIELD_VELOCITY ? state.v[d] : 0;
    if (field != FIELD_VELOCITY) value[0] = problem_field(&state, field);
    return sqrt(result->problem.gamma * state.P / state.rho);
}

static bool in_window(const struct run_result *result, size_t i)
{
    double position[3];
    problem_position(&result->problem, &result->snapshot, i, position);
    return window_contains(&result->problem.window, position);
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
    const char *names[JUDGED_MAX];
    *judged = (struct judged){"density", result->errors[FIELD_DENSITY].l1, (double)NAN};
    if (result->problem.domain.dim == 1) return;
    *judged = (struct judged){"", (double)NAN, (double)NAN};
    if (!judged_names_of(file, result, names)) return;
    judged->name = names[0];
    const int field = family_index(&field_family, names[0]);
    if (field >= 0) {
        judged->error = result->errors[field].l1;
        judged->signal = signal_of(result, (enum field)field);
    } else if (strcmp(names[0], "azimuthal") == 0) {
        judged->error = result->azimuthal.l1;
        judged->signal = signal_of(result, FIELD_VELOCITY);
    }
    for (size_t i = 0; i < result->functional_count && field < 0; i++) {
        const struct run_functional *f = &result->functionals[i];
        if (strcmp(f->name, names[0])) continue;
        judged->error = fabs(f->value - f->exact);
        judged->signal = f->exact < 0 || f->exact > 0 ? fabs(f->exact) : 1;
    }
}
