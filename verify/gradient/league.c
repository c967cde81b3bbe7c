/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "league.h"

#include <math.h>
#include <stdlib.h>

#include "clock.h"
#include "gradient_study.h"
#include "order.h"
#include "pair_forces.h"
#include "result.h"

enum { LEVELS = 4, REPEATS = 3 };

static const struct {
    double eta;
    size_t side[LEVELS]; /* for the order; the second one also for exactness */
    size_t timed;
} plan[] = {{0, {0}, 0},
            {2, {40, 60, 90, 135}, 20000},
            {2.4, {14, 20, 28, 40}, 110},
            {2.4, {10, 12, 14, 17}, 22}};

static enum status errors_on(const struct gradient_subject *subject, const struct kernel *kernel,
                             struct clouds_settings settings, enum gradient_function field,
                             struct gradient_errors *errors, struct error *error)
{
    struct clouds_cloud cloud;
    enum status status = clouds_make(&settings, &cloud, error);
    if (!status)
        status = gradient_study_errors(subject, kernel, &settings, &cloud, field, errors, error);
    clouds_free(&cloud);
    return status;
}

/* The highest degree up to which all polynomials are exact; -1: not even constants. */
static enum status degree_of(const struct gradient_subject *subject, const struct kernel *kernel,
                             const struct clouds_settings *settings, int *degree,
                             struct error *error)
{
    struct gradient_errors errors;
    for (*degree = -1; *degree < FUNCTION_CUBIC; ++*degree) {
        const enum status status = errors_on(subject, kernel, *settings,
                                             (enum gradient_function)(*degree + 1), &errors, error);
        if (status) return status;
        if (!(errors.interior <= 1e-12 * fmax(errors.condition, 1))) break;
    }
    return STATUS_OK;
}

static enum status order_of(const struct gradient_subject *subject, const struct kernel *kernel,
                            struct clouds_settings settings, double *order, struct error *error)
{
    double spacing[LEVELS], value[LEVELS];
    struct order_fit fit;
    for (int l = 0; l < LEVELS; l++) {
        struct gradient_errors errors;
        settings.side = plan[settings.dim].side[l];
        spacing[l] = 1 / (double)settings.side;
        const enum status status =
            errors_on(subject, kernel, settings, FUNCTION_SMOOTH, &errors, error);
        if (status) return status;
        value[l] = errors.interior_rms / spacing[l]; /* was in units of max|f|/h */
    }
    const enum status status = order_fit(LEVELS, spacing, value, NULL, &fit, error);
    *order = fit.order;
    return status;
}

/* Least CPU time of some repeats of a whole call. */
static enum status cost_of(const struct operator_form *form, const struct kernel *kernel,
                           struct clouds_settings settings, struct league_row *row,
                           struct error *error)
{
    struct clouds_cloud cloud;
    uint64_t pairs = 0;
    settings.side = plan[settings.dim].timed;
    enum status status = clouds_make(&settings, &cloud, error);
    const size_t n = cloud.cloud.points.n;
    double *g = calloc(3 * n, sizeof *g), best = HUGE_VAL;
    double *const gradient[3] = {g, g + n, g + 2 * n};
    const double *const fields[] = {cloud.x[0]};
    const struct operator_settings how = {form, kernel, false, 1};
    if (!status && !g) status = error_set(error, STATUS_ENVIRONMENT, "no memory for a cloud");
    for (int k = 0; !status && k < REPEATS; k++) {
        const double begin = clock_thread();
        status = operator_apply(&how, &cloud.cloud, 1, fields, gradient, NULL, &pairs, error);
        best = fmin(best, clock_thread() - begin);
    }
    row->ns_per_point = 1e9 * best / (double)n;
    row->ns_per_pair = 1e9 * best / (double)pairs;
    row->neighbours = (double)pairs / (double)n;
    free(g);
    clouds_free(&cloud);
    return status;
}

static enum status measure(const struct operator_form *form, int dim, struct league_row *row,
                           struct error *error)
{
    const struct gradient_subject subject = {form, NAIVE_NONE};
    const struct pair_forces_subject forces = {subject, FORMULATION_VANILLA_ICE, FORCES_RIGHT};
    struct clouds_settings lattice = {CLOUDS_LATTICE, dim, plan[dim].side[1], 0.2,
                                      plan[dim].eta,  3};
    struct clouds_settings disordered = lattice;
    struct pair_forces_rates rates = {(double)NAN, (double)NAN, (double)NAN};
    struct gradient_errors errors = {0};
    struct kernel kernel;
    disordered.kind = CLOUDS_JITTERED;
    *row = (struct league_row){.name = form->member.name, .dim = dim};
    enum status status = kernel_select(&kernel, "cubic_spline", 5, error);
    if (!status) status = degree_of(&subject, &kernel, &lattice, &row->degree_lattice, error);
    if (!status) status = degree_of(&subject, &kernel, &disordered, &row->degree_disordered, error);
    if (!status) status = order_of(&subject, &kernel, lattice, &row->order_lattice, error);
    if (!status) status = order_of(&subject, &kernel, disordered, &row->order_disordered, error);
    if (!status) status = errors_on(&subject, &kernel, disordered, FUNCTION_SMOOTH, &errors, error);
    if (!status) status = cost_of(form, &kernel, disordered, row, error);
    if (!status && !pair_forces_rates(&forces, dim, 47, &rates))
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for a state");
    row->error = errors.interior_rms, row->error_edge = errors.edge;
    row->condition = errors.condition;
    row->momentum = rates.momentum, row->angular = rates.angular;
    return status;
}

enum status league_measure(struct league_row **rows, size_t *count, struct error *error)
{
    *count = 3 * operator_family.n;
    *rows = calloc(*count, sizeof **rows);
    enum status status =
        *rows ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for a league");
    for (size_t i = 0; i < *count && !status; i++)
        status =
            measure((const struct operator_form *)operator_family.members[i % operator_family.n],
                    1 + (int)(i / operator_family.n), &(*rows)[i], error);
    if (status) free(*rows), *rows = NULL;
    return status;
}

/* Rounds to three digits, for a table. */
static json_t *rounded(double value)
{
    if (!isfinite(value) || value == 0) return result_number(value);
    const double unit = pow(10, floor(log10(fabs(value))) - 2);
    return result_number(unit < 1 ? round(value / unit) / round(1 / unit)
                                  : round(value / unit) * unit);
}

json_t *league_json(const struct league_row *rows, size_t count)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) {
        const struct league_row *r = &rows[i];
        json_array_append_new(
            list,
            json_pack("{s:s, s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
                      "operator", r->name, "dim", r->dim, "exact_degree_lattice", r->degree_lattice,
                      "exact_degree_disordered", r->degree_disordered, "order_lattice",
                      rounded(r->order_lattice), "order_disordered", rounded(r->order_disordered),
                      "error_disordered", rounded(r->error), "error_edge", rounded(r->error_edge),
                      "condition", rounded(r->condition), "momentum_defect", rounded(r->momentum),
                      "angular_momentum_defect", r->dim == 1 ? json_null() : rounded(r->angular),
                      "neighbours", rounded(r->neighbours), "ns_per_point",
                      rounded(r->ns_per_point), "ns_per_pair", rounded(r->ns_per_pair)));
    }
    return json_pack("{s:o, s:s}", "rows", list, "reproduce",
                     "sphproof verify gradients conservation");
}
