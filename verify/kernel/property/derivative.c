/* SPDX-License-Identifier: GPL-3.0-or-later
 * dW/dr and dW/dh against derivatives that use nothing but W: slopes of Chebyshev series through W
 * in r at fixed h, and in h at fixed r, within one piece. */
#include <math.h>

#include "places.h"
#include "property.h"

/* The error estimate of the series is a typical, not a largest error. */
static const double margin = 30;

/* Differentiation amplifies noise: the greatest bound in double and in single precision. */
static double most(const struct pieces *pieces)
{
    return pieces->terms.single ? 1e-2 : 1e-6;
}

static void radial_piece(const struct pieces *pieces, double a, double b, double h,
                         struct property_worst *worst)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    const double half = (b - a) / 2, unit = kernel->constant[dim] * pow(h, -dim - 1);
    double values[PIECES_NODES], slopes[PIECES_NODES];
    struct series_fit fit, slope_fit;
    for (int j = 0; j < PIECES_NODES; j++) {
        const double r = (a + half * (1 + pieces->node[j])) * h;
        values[j] = kernel_value(kernel, r, h, dim);
        slopes[j] = kernel_dr(kernel, r, h, dim);
    }
    pieces_fit(pieces, values, &fit);
    pieces_fit(pieces, slopes, &slope_fit);
    for (int j = 0; j < PIECES_NODES; j += 3) {
        double floor;
        const double x = pieces->node[j], q = a + half * (1 + x);
        const double slope = pieces_series_slope(&fit, x, &floor) / (half * h);
        const double error = fabs(slope - slopes[j]);
        const double scale = fabs(unit) * pieces->max_dw;
        floor =
            (floor / (half * h) + slope_fit.noise * slope_fit.reach) / scale + 4 * pieces->epsilon;
        property_keep(worst, error / scale, fmin(margin * floor, most(pieces)), floor,
                      "h %g, q %.6g", h, q);
    }
}

void property_radial_derivative(const struct pieces *pieces, struct property_sink *sink)
{
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        struct property_worst worst = {0};
        for (int p = 0; p < pieces->n; p++)
            radial_piece(pieces, pieces->edge[p], pieces->edge[p + 1], property_width[i], &worst);
        property_take_worst(sink, &worst);
    }
}

/* At r = q h: the widths that keep r/h inside the piece ]a, b[, at most 10 % off h. */
static void width_point(const struct pieces *pieces, double a, double b, double q, double h,
                        struct property_worst *worst)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    const double r = q * h;
    const double lo = fmax(0.9 * h, r / b), hi = a > 0 ? fmin(1.1 * h, r / a) : 1.1 * h;
    const double half = (hi - lo) / 2, middle = lo + half;
    const double unit = fabs(kernel->constant[dim]) * pow(h, -dim - 1);
    const double scale = unit * (dim * pieces->max_w + pieces->max_dw);
    double values[PIECES_NODES], floor;
    struct series_fit fit;
    for (int j = 0; j < PIECES_NODES; j++)
        values[j] = kernel_value(kernel, r, middle + half * pieces->node[j], dim);
    pieces_fit(pieces, values, &fit);
    const double slope = pieces_series_slope(&fit, (h - middle) / half, &floor) / half;
    const double error = fabs(slope - kernel_dh(kernel, r, h, dim));
    floor = floor / half / scale + 8 * pieces->epsilon;
    property_keep(worst, error / scale, fmin(margin * floor, most(pieces)), floor, "h %g, q %.6g",
                  h, q);
}

/* W, dW/dr and dW/dh at (r, h) against C_d h^-d w and what follows from it. */
static void compare_at(const struct pieces *pieces, double q, double h,
                       struct property_worst *worst)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    const double r = q * h, unit = fabs(kernel->constant[dim]) * pow(h, -dim - 1);
    const double scale = unit * (dim * pieces->max_w + pieces->max_dw);
    q = r / h;
    const double w = kernel->w(kernel, q, dim), dw = kernel->dw(kernel, q, dim);
    const double dh = -unit * (dim * w + q * dw),
                 errors[] = {fabs(kernel_value(kernel, r, h, dim) - unit * h * w) / h,
                             fabs(kernel_dr(kernel, r, h, dim) - unit * dw),
                             fabs(kernel_dh(kernel, r, h, dim) - dh)};
    static const char *const names[] = {"W", "dW/dr", "dW/dh"};
    for (int i = 0; i < 3; i++)
        property_keep(worst, errors[i] / scale, 1e-12, 1e-14,
                      "h %.6g, q %.17g, %s against C_d h^-d w and its derivatives", h, q, names[i]);
}

/* At h over many decades and random q, and at h = 1 where a formula is likely to change. */
static void compare_formula(const struct pieces *pieces, struct property_sink *sink)
{
    const struct terms *terms = &pieces->terms;
    const double decades = terms->single ? 6 : 30;
    struct property_worst random = {0}, likely = {0};
    for (uint64_t i = 0; i < (uint64_t)terms->samples / 4; i++)
        compare_at(pieces, places_random(terms->seed, 2 * i),
                   pow(10, decades * (2 * places_random(terms->seed, 2 * i + 1) - 1)), &random);
    property_take_worst(sink, &random);
    for (int i = 0; i < pieces->place_count; i++) compare_at(pieces, pieces->places[i], 1, &likely);
    property_take_worst(sink, &likely);
}

void property_width_derivative(const struct pieces *pieces, struct property_sink *sink)
{
    enum { POINTS = 7 };
    compare_formula(pieces, sink);
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        const double h = property_width[i];
        struct property_worst worst = {0};
        for (int p = 0; p < pieces->n; p++) {
            const double a = pieces->edge[p], b = pieces->edge[p + 1];
            if (p == 0) width_point(pieces, a, b, 0, h, &worst);
            for (int j = 0; j < POINTS; j++)
                width_point(pieces, a, b, a + (b - a) * (j + 0.5) / POINTS, h, &worst);
        }
        property_take_worst(sink, &worst);
    }
}
