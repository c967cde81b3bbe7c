/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fourier (1D), Hankel (2D) and spherical transform (3D) of a kernel: radial quadrature against
 * cos, J0 and sinc. */
#include "measure.h"

#include <math.h>
#include <stdlib.h>

#include <gsl/gsl_integration.h>
#include <gsl/gsl_roots.h>

/* 32 points resolve the integrand on an interval of 0.2: at most 20 radians to either side. */
enum { NODES = 32 };
static const double width = 0.2;
static const double step = 0.25; /* in kappa: a fraction of the width of the narrowest lobe, pi */

static void add_nodes(struct measure_spectrum *spectrum, const struct pieces *pieces, double a,
                      double b, const gsl_integration_glfixed_table *table)
{
    const int dim = spectrum->dim;
    for (size_t i = 0; i < NODES; i++) {
        double q, weight;
        gsl_integration_glfixed_point(a, b, i, &q, &weight, table);
        spectrum->q[spectrum->n] = q;
        spectrum->weight[spectrum->n++] = measure_sphere(dim) * weight * pow(q, dim - 1) *
                                          kernel_value(pieces->kernel, q, 1, dim);
    }
}

enum status measure_spectrum_make(struct measure_spectrum *spectrum, const struct pieces *pieces,
                                  struct error *error)
{
    const size_t capacity = NODES * ((size_t)pieces->n + (size_t)(1 / width) + 1);
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(NODES);
    *spectrum = (struct measure_spectrum){.dim = pieces->dim};
    spectrum->q = malloc(capacity * sizeof *spectrum->q);
    spectrum->weight = malloc(capacity * sizeof *spectrum->weight);
    const bool made = table && spectrum->q && spectrum->weight;
    for (int i = 0; made && i < pieces->n; i++) {
        const double a = pieces->edge[i], b = pieces->edge[i + 1];
        const int parts = (int)ceil((b - a) / width);
        for (int part = 0; part < parts; part++)
            add_nodes(spectrum, pieces, a + (b - a) * part / parts,
                      a + (b - a) * (part + 1) / parts, table);
    }
    if (table) gsl_integration_glfixed_table_free(table);
    if (made) return STATUS_OK;
    measure_spectrum_free(spectrum);
    return error_set(error, STATUS_ENVIRONMENT, "no memory for the transform of a kernel");
}

void measure_spectrum_free(struct measure_spectrum *spectrum)
{
    free(spectrum->q);
    free(spectrum->weight);
    *spectrum = (struct measure_spectrum){0};
}

double measure_transform(const struct measure_spectrum *spectrum, double kappa)
{
    double sum = 0;
    for (int i = 0; i < spectrum->n; i++) {
        const double x = kappa * spectrum->q[i];
        const double wave = spectrum->dim == 1   ? cos(x)
                            : spectrum->dim == 2 ? j0(x)
                            : x > 0              ? sin(x) / x
                                                 : 1;
        sum += spectrum->weight[i] * wave;
    }
    return sum;
}

static double transform_for_root(double kappa, void *spectrum)
{
    return measure_transform(spectrum, kappa);
}

/* The zero between a (positive) and b (negative) by Brent's method. */
static double zero_between(const struct measure_spectrum *spectrum, double a, double b)
{
    struct measure_spectrum copy = *spectrum;
    gsl_function f = {transform_for_root, &copy};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (solver && gsl_root_fsolver_set(solver, &f, a, b) == 0)
        for (int i = 0; i < 60 && b - a > 1e-12 * b; i++) {
            if (gsl_root_fsolver_iterate(solver)) break;
            a = gsl_root_fsolver_x_lower(solver);
            b = gsl_root_fsolver_x_upper(solver);
        }
    const double root = solver ? gsl_root_fsolver_root(solver) : (double)NAN;
    if (solver) gsl_root_fsolver_free(solver);
    return root;
}

void measure_fourier(const struct measure_spectrum *spectrum, struct measure_fourier *result)
{
    *result = (struct measure_fourier){
        .least = (double)INFINITY, .first_negative = (double)NAN, .floor = 1e-13};
    double positive = 0; /* the last kappa with a positive transform */
    for (double kappa = step; kappa <= MEASURE_KAPPA_MAX; kappa += step) {
        const double value = measure_transform(spectrum, kappa);
        if (isnan(value)) result->least = value;
        if (value < result->least) {
            result->least = value;
            result->least_at = kappa;
        }
        if (value < -result->floor && isnan(result->first_negative))
            result->first_negative = zero_between(spectrum, positive, kappa);
        if (value > 0) positive = kappa;
    }
}
