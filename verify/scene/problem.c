/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "problem.h"

#include <math.h>

#include "norm.h"

#define PROBLEM(name) extern const struct problem problem_##name;
#include "problems.def"
#undef PROBLEM

static const struct member *const members[] = {
#define PROBLEM(name) &problem_##name.member,
#include "problems.def"
#undef PROBLEM
};

const struct family problem_family = {"problems", "initial states and what they are judged by",
                                      members, sizeof members / sizeof *members};

const struct problem *problem_of(const struct settings *settings)
{
    return (const struct problem *)members[settings_choice(settings, SETTING_kind)];
}

static bool calls_its_own(const struct problem *problem, enum setting key)
{
    for (size_t i = 0; i < problem->key_count; i++)
        if (problem->keys[i].key == key) return true;
    return false;
}

bool problem_reads(const struct problem *problem, enum setting key)
{
    if (calls_its_own(problem, key)) return true;
    for (size_t i = 0; i < problem_family.n; i++)
        if (calls_its_own((const struct problem *)members[i], key)) return false;
    return true;
}

enum status problem_check_state(const struct settings *settings, enum setting key,
                                struct error *error)
{
    const double *state = settings->value[key].real;
    if (state[0] > 0 && state[2] > 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "%s=\"%g %g %g\": rho v P with rho > 0 and P > 0 is needed%s",
                     setting_keys[key].name, state[0], state[1], state[2],
                     state[0] == 0 ? " (particles cannot fill a vacuum)" : "");
}

/* What concerns two keys, neither of them the problem's own. */
static enum status check_together(const struct prepared *p, const struct settings *settings,
                                  struct error *error)
{
    const struct problem *problem = p->problem;
    const double lo = p->domain.lo[0], hi = p->domain.hi[0];
    const double *window = settings->value[SETTING_window].real;
    if (!(lo < hi))
        return error_set(error, STATUS_BAD_INPUT, "lo=%g hi=%g: lo < hi is needed", lo, hi);
    if (!(lo <= window[0] && window[0] < window[1] && window[1] <= hi))
        return error_set(error, STATUS_BAD_INPUT,
                         "window=\"%g %g\": two rising numbers in the box [%g, %g] are needed",
                         window[0], window[1], lo, hi);
    if (!(p->domain.dim >= problem->least_dim && p->domain.dim <= problem->most_dim))
        return error_set(error, STATUS_BAD_INPUT,
                         "%s has no form in %d dimensions; allowed: %d to %d", problem->member.name,
                         p->domain.dim, problem->least_dim, problem->most_dim);
    for (int i = 0; i < SETTINGS; i++)
        if (settings->value[i].source == SOURCE_USER && !problem_reads(problem, (enum setting)i))
            return error_set(error, STATUS_BAD_INPUT,
                             "key %s and an initial state of kind %s exclude each other: it has "
                             "no such thing",
                             setting_keys[i].name, problem->member.name);
    return STATUS_OK;
}

enum status problem_prepare_as(struct prepared *p, const struct problem *problem,
                               struct settings *settings, int dim, struct error *error)
{
    *p = (struct prepared){.problem = problem,
                           .domain = {.dim = dim},
                           .window = {.dim = dim},
                           .gamma = settings_real(settings, SETTING_gamma)};
    for (int d = 0; d < dim; d++) {
        p->domain.lo[d] = p->window.lo[d] = settings_real(settings, SETTING_lo);
        p->domain.hi[d] = p->window.hi[d] = settings_real(settings, SETTING_hi);
    }
    p->window.lo[0] = settings->value[SETTING_window].real[0];
    p->window.hi[0] = settings->value[SETTING_window].real[1];
    if (check_together(p, settings, error)) return error->status;
    return problem->prepare(p, settings, error);
}

enum status problem_prepare(struct prepared *p, struct settings *settings, int dim,
                            struct error *error)
{
    return problem_prepare_as(p, problem_of(settings), settings, dim, error);
}

void problem_sample(const struct prepared *p, const double x[3], double t,
                    struct problem_state *state)
{
    p->problem->sample(p, x, t, state);
}

double problem_field(const struct problem_state *state, enum field field)
{
    const double values[FIELDS] = {state->rho, state->v[0], state->P, state->u};
    return values[field];
}

struct field_at {
    const struct prepared *p;
    double time;
    enum field field;
};

static double field_value(const void *context, double x)
{
    const struct field_at *at = context;
    struct problem_state state;
    problem_sample(at->p, (double[3]){x}, at->time, &state);
    return problem_field(&state, at->field);
}

void problem_means(const struct prepared *p, enum field field, double t, size_t bins, double *means)
{
    const struct field_at at = {p, t, field};
    const double window[2] = {p->window.lo[0], p->window.hi[0]};
    norm_bin_means(field_value, &at, window, bins, means);
}

enum status problem_check_time(const struct prepared *p, double t, struct error *error)
{
    const struct problem *problem = p->problem;
    if (!problem->holds || problem->holds(p, t)) return STATUS_OK;
    double longest = 0, reached = t;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (longest + reached);
        *(problem->holds(p, middle) ? &longest : &reached) = middle;
    }
    longest *= 1 - 1e-3; /* as printed it shall still be allowed */
    return problem->refuse(p, t, longest, error);
}

void problem_place(const struct prepared *p, const struct snapshot *s, size_t i, double x[3])
{
    for (int d = 0; d < 3; d++) x[d] = d < p->domain.dim ? s->x[d][i] : 0;
}
