/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_part.h"

#include <math.h>
#include <stdlib.h>

#include "functional.h"
#include "growth.h"
#include "user_solution.h"

/* Measured and exact values for the errors, n numbers each. */
struct comparison {
    double *exact[FIELDS]; /* of each field at the particles; velocity along x */
    double *where;         /* 0: in the window, 2: outside, NaN: position is not finite */
    double *none;          /* zeros */
    double *part;          /* volume in the window */
    double *inside;        /* volume of the particles in the window, 0 of the others */
    double *jump;          /* |v - exact v| */
    double *azimuthal[2], *radial[2]; /* measured and exact values */
    double *storage;
};

/* Radius of the ball with the volume of a particle. */
static double own_reach(int dim, double volume)
{
    static const double balls[] = {0, 2, M_PI, 4 * M_PI / 3};
    return pow(volume / balls[dim], 1. / dim);
}

/* If the volume of a particle contains a point where u is unbounded, replaces the exact u by the
 * mean over a ball of this volume. */
static void bound_energy(const struct run_result *result, size_t i, const double position[3],
                         struct problem_state *state)
{
    const struct prepared *p = &result->problem;
    if (!p->problem->mean_energy) return;
    const double reach = own_reach(p->domain.dim, result->snapshot.volume[i]);
    if (problem_radius(p, position) < reach)
        state->u = p->problem->mean_energy(p, reach, result->time);
}

static bool compare(struct comparison *of, const struct run_result *result)
{
    const struct prepared *p = &result->problem;
    const struct snapshot *s = &result->snapshot;
    double *next = of->storage = calloc((FIELDS + 9) * s->n, sizeof *next);
    double **const arrays[] = {&of->where,     &of->none,         &of->part,
                               &of->jump,      &of->azimuthal[0], &of->azimuthal[1],
                               &of->radial[0], &of->radial[1],    &of->inside};
    if (!next) return false;
    for (int f = 0; f < FIELDS; f++, next += s->n) of->exact[f] = next;
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++, next += s->n) *arrays[k] = next;
    for (size_t i = 0; i < s->n; i++) {
        struct problem_state state;
        double exact_v[3] = {0}, position[3], v[3], squares = 0;
        problem_sample_particle(p, s, i, &state);
        problem_position(p, s, i, position);
        bound_energy(result, i, position, &state);
        for (int f = 0; f < FIELDS; f++) of->exact[f][i] = problem_field(&state, (enum field)f);
        problem_velocity(p, s, i, v);
        for (int d = 0; d < p->domain.dim; d++) {
            exact_v[d] = state.v[d] - p->boost[d];
            squares += (v[d] - exact_v[d]) * (v[d] - exact_v[d]);
        }
        of->where[i] = window_contains(&p->window, position) ? 0 : 2;
        for (int d = 0; d < p->domain.dim; d++) of->where[i] += 0 * s->x[d][i]; /* NaN if x is */
        of->part[i] = problem_window_part(p, s, i);
        of->inside[i] = of->where[i] > 0 ? 0 : s->volume[i];
        of->jump[i] = sqrt(squares);
        if (!problem_is_circular(p)) continue;
        problem_circular(p, position, v, &of->azimuthal[0][i], &of->radial[0][i]);
        problem_circular(p, position, exact_v, &of->azimuthal[1][i], &of->radial[1][i]);
    }
    return true;
}

/* Warns if a field is closer to the exact values of another field than to its own. */
static void suspect(struct run_result *result, const double *const *measured,
                    const struct comparison *of)
{
    static const char *const names[] = {"density", "velocity", "pressure", "energy"};
    /* near a point explosion the energy per mass is unbounded */
    const size_t bounded = result->problem.problem->mean_energy ? FIELD_INTERNAL_ENERGY : FIELDS;
    for (int field = 0; field < FIELDS; field++)
        if (!problem_knows(result->problem.problem, (enum field)field)) return;
    suspicion_swapped(bounded, names, result->snapshot.n, of->inside, measured,
                      (const double *const *)of->exact, result->suspicion);
}

static const struct norms no_norms = {.l1 = (double)NAN,
                                      .l2 = (double)NAN,
                                      .linf = (double)NAN,
                                      .particle_mean = (double)NAN,
                                      .l1_whole = (double)NAN};

/* All norms over the particles in the window, but L1 over the parts of all volumes in it. */
static struct norms norms_of(const struct snapshot *s, const struct comparison *of,
                             const double *value, const double *exact)
{
    static const double window[2] = {-1, 1};
    struct norms norms = norm_errors(s->n, of->where, window, s->volume, value, exact);
    if (norms.n) norms.l1 = norm_l1(s->n, of->part, value, exact);
    return norms;
}

/* Measures in 1D, where density is also compared in bins. */
static void measure_line(struct run_result *result, const double *const *measured,
                         const struct comparison *of)
{
    const struct snapshot *s = &result->snapshot;
    const double window[2] = {result->problem.window.lo[0], result->problem.window.hi[0]};
    double means[NORM_BINS];
    for (int field = 0; field < FIELDS; field++)
        if (problem_knows(result->problem.problem, (enum field)field))
            result->errors[field] = norms_of(s, of, measured[field], of->exact[field]);
    if (!problem_knows(result->problem.problem, FIELD_DENSITY)) return;
    problem_means(&result->problem, FIELD_DENSITY, result->time, NORM_BINS, means);
    result->binned_density_l1 =
        norm_binned_l1(s->n, s->x[0], window, s->volume, s->rho, NORM_BINS, means);
}

static void measure_cloud(struct run_result *result, const double *const *measured,
                          const struct comparison *of)
{
    const struct snapshot *s = &result->snapshot;
    for (int field = 0; field < FIELDS; field++) {
        const bool vector = field == FIELD_VELOCITY;
        if (!problem_knows(result->problem.problem, (enum field)field)) continue;
        result->errors[field] = norms_of(s, of, vector ? of->jump : measured[field],
                                         vector ? of->none : of->exact[field]);
    }
    if (!problem_is_circular(&result->problem)) return;
    result->azimuthal = norms_of(s, of, of->azimuthal[0], of->azimuthal[1]);
    result->radial = norms_of(s, of, of->radial[0], of->radial[1]);
}

void run_measure_nothing(struct run_result *result)
{
    result->azimuthal = result->radial = no_norms;
    result->binned_density_l1 = (double)NAN;
    for (int field = 0; field < FIELDS; field++) {
        result->errors[field] = no_norms;
        result->interpolation[field] = (double)NAN;
    }
}

/* Splits the L1 norms by the regions of the problem; exact_values[f]: field f at the n
 * particles. */
static void measure_budget(const struct prepared *p, const struct snapshot *s,
                           const double *const *exact_values, struct budget *budget)
{
    const struct regions *regions = p->problem->regions;
    *budget = (struct budget){.regions = regions, .still = NAN};
    if (!regions) return;
    const double *const fields[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    double volume = 0, x[3];
    for (size_t i = 0; i < s->n; i++) {
        const double part = problem_window_part(p, s, i);
        if (part == 0) continue;
        problem_position(p, s, i, x);
        const size_t region = regions->at(p, x, BUDGET_REACH * s->h[i], s->time);
        volume += part;
        for (int f = 0; f < FIELDS; f++)
            budget->l1[region][f] += part * fabs(fields[f][i] - exact_values[f][i]);
    }
    for (size_t r = 0; regions->names[r]; r++)
        for (int f = 0; f < FIELDS; f++) budget->l1[r][f] /= volume;
    budget->still = regions->still(p, s);
}

enum status run_measure_errors(struct run_result *result, struct error *error)
{
    const struct snapshot *s = &result->snapshot;
    const double *const measured[FIELDS] = {s->rho, s->v[0], s->P, s->u};
    struct comparison of;
    run_measure_nothing(result);
    if (result->problem.problem->fieldless) return STATUS_OK;
    user_solution_error(&result->problem, s, result->interpolation);
    if (!compare(&of, result))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for the errors");
    (result->problem.domain.dim == 1 ? measure_line : measure_cloud)(result, measured, &of);
    suspect(result, measured, &of);
    measure_budget(&result->problem, s, (const double *const *)of.exact, &result->budget);
    free(of.storage);
    return STATUS_OK;
}

void run_measure_functionals(struct run_result *result)
{
    const struct prepared *p = &result->problem;
    const struct growing *growing = p->problem->growing;
    result->h = functional_window_mean(p, &result->snapshot, result->snapshot.h);
    for (const struct functional *const *f = p->problem->functionals; *f; f++) {
        if ((*f)->present && !(*f)->present(p)) continue;
        result->functionals[result->functional_count++] = (struct run_functional){
            .name = (*f)->name,
            .value = (*f)->measure(p, &result->snapshot),
            .exact = (*f)->exact ? (*f)->exact(p, result->time) : (double)NAN};
    }
    if (!growing) return;
    result->functionals[result->functional_count++] =
        (struct run_functional){growing->name, growth_rate(&result->growth), growing->rate(p)};
}
