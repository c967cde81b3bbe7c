/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "operator.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "operator_sums.h"
#include "units.h"

#define OPERATOR(name, vectors, difference, corrected, exact, exact_on_lattice, label, paper)      \
    static const struct operator_form operator_##name = {                                          \
        {#name, label, paper}, vectors, difference, corrected, exact, exact_on_lattice};
#include "operators.def"
#undef OPERATOR

static const struct member *const members[] = {
#define OPERATOR(name, ...) &operator_##name.member,
#include "operators.def"
#undef OPERATOR
};

const struct family operator_family = {"operators", "gradient operators on a cloud of points",
                                       members, sizeof members / sizeof *members};

const char *operator_state_name(enum operator_state state)
{
    static const char *const names[] = {"ok",       "too_few_neighbours", "ill_conditioned",
                                        "singular", "overflow",           "underflow"};
    return names[state];
}

static enum status check(const struct cloud *cloud, struct error *error)
{
    for (size_t i = 0; i < cloud->points.n; i++) {
        if (!(cloud->h[i] > 0 && isfinite(cloud->h[i])))
            return error_set(error, STATUS_BAD_INPUT,
                             "point %zu: support radius h = %g; it must be positive", i,
                             cloud->h[i]);
        if (!(cloud->volume[i] > 0 && isfinite(cloud->volume[i])))
            return error_set(error, STATUS_BAD_INPUT, "point %zu: volume = %g; it must be positive",
                             i, cloud->volume[i]);
    }
    return STATUS_OK;
}

static enum status apply(const struct operator_settings *settings, const struct cloud *cloud,
                         size_t fields, const double *const *f, double *const *gradient,
                         struct operator_point *point, uint64_t *pairs, struct error *error)
{
    struct neighbours *nb;
    enum status status;
    if ((status = neighbours_create(&cloud->points, &nb, error))) return status;
    const size_t n = nb->n;
    struct operator_task task = {.settings = settings,
                                 .neighbours = nb,
                                 .shapes = shapes_of(settings->kernel, nb->dim, !settings->generic),
                                 .fields = fields,
                                 .sorted = malloc((2 + fields) * (n + 1) * sizeof(double)),
                                 .gradient = gradient,
                                 .point = point};
    if (task.sorted) {
        task.volume = task.sorted;
        task.h = task.sorted + n;
        for (size_t k = 0; k < 2 + fields; k++) {
            const double *from = k == 0 ? cloud->volume : k == 1 ? cloud->h : f[k - 2];
            for (size_t s = 0; s < n; s++) task.sorted[k * n + s] = from[nb->order[s]];
        }
        status = operator_sums(&task, pairs, error);
    } else {
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for %zu fields of %zu points",
                           fields, n);
    }
    free(task.sorted);
    neighbours_destroy(nb);
    return status;
}

static bool ordinary(const struct cloud *cloud, size_t fields, const double *const *f)
{
    bool all =
        units_ordinary(cloud->points.n, cloud->h) && units_ordinary(cloud->points.n, cloud->volume);
    for (size_t k = 0; k < fields; k++) all = all && units_ordinary(cloud->points.n, f[k]);
    return all;
}

/* Converts one component of a field's gradients back to the caller's units. */
static void give_back(size_t n, int e, double *gradient, struct operator_point *point)
{
    for (size_t i = 0; i < n; i++) {
        const double found = gradient[i];
        gradient[i] = ldexp(found, e);
        if (!point || point[i].state != OPERATOR_OK || !isfinite(found)) continue;
        if (!isfinite(gradient[i])) point[i].state = OPERATOR_OVERFLOW;
        if (fabs(gradient[i]) < DBL_MIN && fabs(found) > 0) point[i].state = OPERATOR_UNDERFLOW;
    }
}

/* e: exponents of the units of length, of volume, then of the fields. */
static enum status apply_in_units(const struct operator_settings *settings,
                                  const struct cloud *cloud, size_t fields, const int *e,
                                  double **scaled, double *const *gradient,
                                  struct operator_point *point, uint64_t *pairs,
                                  struct error *error)
{
    const size_t n = cloud->points.n;
    const int dim = cloud->points.dim;
    const struct operator_form *form = settings->form;
    const bool bare = !form->corrected && form->pair_vector == VECTOR_GRADIENT;
    struct cloud copy = {.h = scaled[0], .volume = scaled[1]};
    bool sound = units_points(&cloud->points, e[0], &copy.points);
    for (size_t k = 0; k < 2 + fields; k++) sound = sound && scaled[k];
    enum status status = sound
                             ? apply(settings, &copy, fields, (const double *const *)scaled + 2,
                                     gradient, point, pairs, error)
                             : error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", n);
    for (size_t k = 0; k < fields && !status; k++)
        for (int a = 0; a < dim; a++)
            give_back(n, e[2 + k] + (bare ? e[1] - (dim + 1) * e[0] : -e[0]),
                      gradient[k * (size_t)dim + (size_t)a], point);
    units_points_free(&copy.points);
    return status;
}

enum status operator_apply(const struct operator_settings *settings, const struct cloud *cloud,
                           size_t fields, const double *const *f, double *const *gradient,
                           struct operator_point *point, uint64_t *pairs, struct error *error)
{
    const size_t n = cloud->points.n;
    enum status status = check(cloud, error);
    if (pairs) *pairs = 0;
    if (status) return status;
    if (ordinary(cloud, fields, f))
        return apply(settings, cloud, fields, f, gradient, point, pairs, error);
    int *e = calloc(2 + fields, sizeof *e);
    double **scaled = calloc(2 + fields, sizeof *scaled);
    for (size_t k = 0; e && scaled && k < 2 + fields; k++) {
        const double *values = k == 0 ? cloud->h : k == 1 ? cloud->volume : f[k - 2];
        e[k] = units_exponent(n, values);
        scaled[k] = units_copy(n, values, e[k]);
    }
    status = e && scaled
                 ? apply_in_units(settings, cloud, fields, e, scaled, gradient, point, pairs, error)
                 : error_set(error, STATUS_ENVIRONMENT, "no memory for %zu fields", fields);
    for (size_t k = 0; scaled && k < 2 + fields; k++) free(scaled[k]);
    free(scaled);
    free(e);
    return status;
}
