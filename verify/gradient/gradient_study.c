/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gradient_study.h"

#include <math.h>
#include <stdlib.h>

#include "worst.h"

const char *gradient_study_field_name(enum gradient_function field)
{
    static const char *const names[] = {"constant", "linear", "quadratic", "cubic", "smooth"};
    return names[field];
}

/* With s = k.x + 0.3: 2.385, then s, s^2 + x0 ..., s^3 + ..., each with all mixed terms. */
double gradient_study_field(enum gradient_function field, int dim, const double *x,
                            double *gradient)
{
    static const double k[3] = {1.8137, -0.7213, 1.2391}, l[3] = {-0.4729, 1.1213, 0.6173};
    double s = 0.3191, t = -0.2713, f = 0, ds = 0, dt = 0;
    for (int a = 0; a < dim; a++) s += k[a] * x[a], t += l[a] * x[a];
    switch (field) {
    case FUNCTION_CONSTANT:
        f = 2.385;
        break;
    case FUNCTION_LINEAR:
        f = 2.385 + s, ds = 1;
        break;
    case FUNCTION_QUADRATIC:
        f = 2.385 + s * t + 0.37 * s * s, ds = t + 0.74 * s, dt = s;
        break;
    case FUNCTION_CUBIC:
        f = 2.385 + s * s * t + 0.23 * t * t * t, ds = 2 * s * t, dt = s * s + 0.69 * t * t;
        break;
    case FUNCTION_SMOOTH:
        f = 2.385 + sin(s) * exp(t), ds = cos(s) * exp(t), dt = sin(s) * exp(t);
    }
    for (int a = 0; a < dim; a++) gradient[a] = ds * k[a] + dt * l[a];
    return f;
}

enum status gradient_study_apply(const struct gradient_subject *subject,
                                 const struct kernel *kernel, const struct cloud *cloud,
                                 const double *f, double *const *gradient,
                                 struct operator_point *point, struct error *error)
{
    const struct operator_settings settings = {subject->form, kernel, false, 1};
    const double *const fields[] = {f};
    const enum status status =
        operator_apply(&settings, cloud, 1, fields, gradient, point, NULL, error);
    for (size_t i = 0; !status && subject->fault && i < cloud->points.n; i++) {
        double g[3];
        naive_gradient(subject->form, kernel, subject->fault, cloud, f, i, g);
        for (int a = 0; a < cloud->points.dim; a++) gradient[a][i] = g[a];
    }
    return status;
}

enum status gradient_study_errors(const struct gradient_subject *subject,
                                  const struct kernel *kernel,
                                  const struct clouds_settings *settings,
                                  const struct clouds_cloud *cloud, enum gradient_function field,
                                  struct gradient_errors *errors, struct error *error)
{
    const size_t n = cloud->cloud.points.n;
    const int dim = settings->dim;
    *errors = (struct gradient_errors){0};
    double *memory = calloc(8 * n, sizeof *memory), largest = 0;
    struct operator_point *point = malloc(n * sizeof *point);
    if (!memory || !point) {
        free(memory), free(point);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for a cloud of %zu points", n);
    }
    double *const f = memory, *const exact = memory + n;
    double *const gradient[3] = {memory + 4 * n, memory + 5 * n, memory + 6 * n};
    for (size_t i = 0; i < n; i++) {
        double x[3] = {0};
        for (int a = 0; a < dim; a++) x[a] = cloud->x[a][i];
        f[i] = gradient_study_field(field, dim, x, exact + 3 * i);
        largest = fmax(largest, fabs(f[i]));
    }
    const enum status status =
        gradient_study_apply(subject, kernel, &cloud->cloud, f, gradient, point, error);
    for (size_t i = 0; !status && i < n; i++) {
        double difference = 0;
        for (int a = 0; a < dim; a++)
            difference = hypot(difference, gradient[a][i] - exact[3 * i + (size_t)a]);
        const double scaled = difference * cloud->h[i] / largest;
        const bool inside = clouds_interior(settings, cloud, i);
        double *worst = inside ? &errors->interior : &errors->edge;
        worst_keep(worst, scaled);
        if (inside) errors->interior_rms += scaled * scaled;
        errors->inside += inside ? 1u : 0u, errors->outside += inside ? 0u : 1u;
        errors->condition = fmax(errors->condition, point[i].condition);
    }
    errors->interior_rms = sqrt(errors->interior_rms / (double)errors->inside);
    free(memory), free(point);
    return status;
}

struct clouds_settings gradient_study_cloud(enum clouds_kind kind, int dim)
{
    static const size_t side[] = {0, 80, 16, 8};
    return (struct clouds_settings){kind, dim, side[dim], 0.3, 2.4, 17};
}
