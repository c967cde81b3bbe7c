/* SPDX-License-Identifier: GPL-3.0-or-later
 * The kernel as an operator: delta limit, Fourier transform, lattice sums. */
#include <float.h>
#include <math.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_bessel.h>

#include "measure.h"
#include "property.h"

/* W times the mean over the sphere |x| = r of f = exp(x_1), whose laplacian is f. */
static double smeared(const struct kernel *kernel, double r, double h, int dim)
{
    const double mean = dim == 1   ? cosh(r)
                        : dim == 2 ? gsl_sf_bessel_I0(r)
                        : r > 0    ? sinh(r) / r
                                   : 1;
    return mean * kernel_value(kernel, r, h, dim);
}

enum { LEVELS = 5 };

/* Limit h -> 0 of values at h, h/2, h/4 ... whose error has even powers of h only (Romberg). */
static double extrapolate(double *value, int n)
{
    double factor = 1;
    for (int column = 1; column < n; column++) {
        factor *= 4;
        for (int i = 0; i + column < n; i++)
            value[i] = (factor * value[i + 1] - value[i]) / (factor - 1);
    }
    return value[0];
}

void property_delta_limit(const struct pieces *pieces, struct property_sink *sink)
{
    const int dim = pieces->dim;
    double error[LEVELS], coefficient[LEVELS], order[LEVELS - 1], floor = 0, h = 0.8;
    struct measure_moments moments;
    measure_moments(pieces, &moments);
    for (int i = 0; i < LEVELS; i++, h /= 2) {
        floor = 0;
        error[i] = measure_sphere(dim) * measure_support(pieces, smeared, dim - 1, h, &floor) - 1;
        coefficient[i] = error[i] / (h * h);
        if (i > 0) order[i - 1] = log2(error[i - 1] / error[i]);
    }
    floor = (measure_sphere(dim) * floor + DBL_EPSILON) / (h * h * 4); /* at the last h */
    const double second = moments.second / 2, constant = extrapolate(coefficient, LEVELS);
    /* a negative lobe may cancel the second moment; the fourth then determines the order */
    const double scale = pieces->terms.negative ? fmax(fabs(second), 0.01) : fabs(second);
    floor /= scale;
    if (pieces->terms.negative)
        property_skip(sink, "declared negative: the order depends on the second moment, %.3g h^2",
                      moments.second);
    else
        property_take(sink, fabs(extrapolate(order, LEVELS - 1) - 2), 60 * floor, floor,
                      "observed order against 2, h 0.8 to 0.05");
    property_take(sink, fabs(constant - second) / scale, 60 * floor, floor,
                  "constant against sigma^2/2");
}

struct wave {
    const struct pieces *pieces;
    int power;
};

static double slope_times_power(double q, void *context)
{
    const struct wave *wave = context;
    return (wave->power ? q : 1) * kernel_dr(wave->pieces->kernel, q, 1, wave->pieces->dim);
}

/* Integral of q^power dw sin(kappa q) (or cos) over the support by GSL's QAWO, piece by piece. */
static double oscillating(const struct pieces *pieces, int power, double kappa,
                          enum gsl_integration_qawo_enum kind, double *floor)
{
    enum { LIMIT = 64, TABLE = 12 };
    struct wave wave = {pieces, power};
    gsl_function f = {slope_times_power, &wave};
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(LIMIT);
    gsl_integration_qawo_table *table = gsl_integration_qawo_table_alloc(kappa, 1, kind, TABLE);
    double sum = space && table ? 0 : (double)NAN;
    for (int i = 0; space && table && i < pieces->n; i++) {
        const double a = pieces->edge[i], b = pieces->edge[i + 1];
        double part = 0, error = 0;
        gsl_integration_qawo_table_set_length(table, b - a);
        gsl_integration_qawo(&f, a, 1e-14 * (b - a), 1e-13, LIMIT, space, table, &part, &error);
        sum += part;
        *floor += error;
    }
    if (table) gsl_integration_qawo_table_free(table);
    if (space) gsl_integration_workspace_free(space);
    return sum;
}

static _Thread_local double
    wave_number; /* for slope_times_bessel, as a measure_function has no context */

static double slope_times_bessel(const struct kernel *kernel, double r, double h, int dim)
{
    return j1(wave_number * r) * kernel_dr(kernel, r, h, dim);
}

/* The transform from dW/dr, by parts. */
static double transform_of_slope(const struct pieces *pieces, double kappa, double *floor)
{
    const int dim = pieces->dim;
    const double factor = -measure_sphere(dim) / (dim == 3 ? kappa * kappa * kappa : kappa);
    double sum = 0;
    if (dim == 2) {
        wave_number = kappa;
        sum = measure_support(pieces, slope_times_bessel, 1, 1, floor);
    } else {
        sum = oscillating(pieces, 0, kappa, GSL_INTEG_SINE, floor);
        if (dim == 3) {
            double second = 0;
            sum -= kappa * oscillating(pieces, 1, kappa, GSL_INTEG_COSINE, &second);
            *floor += kappa * second;
        }
    }
    *floor *= fabs(factor);
    return factor * sum;
}

static void transform_figures(const struct pieces *pieces, const struct measure_spectrum *spectrum,
                              struct property_sink *sink)
{
    static const double kappa[] = {2.385, 7.1, 19.3, 41.9};
    struct measure_moments moments;
    struct property_worst worst = {0};
    for (size_t i = 0; i < sizeof kappa / sizeof *kappa; i++) {
        double floor = 0;
        const double parts = transform_of_slope(pieces, kappa[i], &floor);
        floor += 2e-15;
        property_keep(&worst, fabs(measure_transform(spectrum, kappa[i]) - parts),
                      property_bound(1e-13, floor), floor, "k h = %g, by parts", kappa[i]);
    }
    property_take_worst(sink, &worst);
    measure_moments(pieces, &moments);
    const double small = 0.02, x = small * small;
    const double series = 1 - x / 2 * (moments.second - x / 12 * moments.fourth);
    property_take(sink, fabs(measure_transform(spectrum, small) - series), 1e-13, 2e-15,
                  "k h = %g against 1 - sigma^2 k^2/2 + m_4 k^4/24", small);
}

void property_transform(const struct pieces *pieces, struct property_sink *sink)
{
    struct measure_spectrum spectrum;
    if (measure_spectrum_make(&spectrum, pieces, NULL)) {
        property_take(sink, (double)NAN, 0, 0, "no memory");
        return;
    }
    gsl_error_handler_t *handler =
        gsl_set_error_handler_off(); /* the floor reports failures of the quadrature */
    transform_figures(pieces, &spectrum, sink);
    gsl_set_error_handler(handler);
    measure_spectrum_free(&spectrum);
}

void property_lattice(const struct pieces *pieces, struct property_sink *sink)
{
    const struct kernel *kernel = pieces->kernel;
    const double unity = kernel->unity_width, floor = 2 * DBL_EPSILON;
    double density, gradient;
    for (int m = 1; m <= 3 && unity > 0 && pieces->dim == 1; m++) {
        measure_lattice(kernel, 1, m * unity, &density, &gradient);
        property_take(sink, fmax(fabs(density), fabs(gradient)), 20 * floor, floor,
                      "eta %g: exact width", m * unity);
    }
    if (pieces->dim == 1 && kernel->default_eta > 0) {
        measure_lattice(kernel, 1, kernel->default_eta, &density, &gradient);
        property_take(sink, fmax(fabs(density), fabs(gradient)), 8e-3, floor,
                      "eta %g: the default width", kernel->default_eta);
    }
    /* many neighbours: the sums become integrals, with the order of the transform's decay */
    const double eta = pieces->dim == 1 ? 64 : 16;
    const int class = kernel->smoothness[pieces->dim];
    const int order = pieces->dim == 1 ? 1 + (class > 0) : 1 + (class < 2 ? class : 2);
    const double bound = 4 * pow(eta, -order);
    measure_lattice(kernel, pieces->dim, eta, &density, &gradient);
    property_take(sink, fabs(density), bound, floor, "eta %g, density", eta);
    property_take(sink, fabs(gradient), bound, floor, "eta %g, gradient", eta);
}
