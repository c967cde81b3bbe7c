/* SPDX-License-Identifier: GPL-3.0-or-later
 * Integral properties, each at several h, by quadrature between the break points. */
#include <float.h>
#include <math.h>

#include "measure.h"
#include "property.h"

void property_normalisation(const struct pieces *pieces, struct property_sink *sink)
{
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        double floor = 0;
        const double h = property_width[i], sphere = measure_sphere(pieces->dim);
        const double sum =
            sphere * measure_support(pieces, kernel_value, pieces->dim - 1, h, &floor);
        floor = sphere * floor + 4 * DBL_EPSILON;
        property_take(sink, fabs(sum - 1), property_bound(1e-13, floor), floor, "h %g", h);
    }
}

/* In spherical coordinates the integral of n_k n_l over the directions is delta_kl sphere/d. */
void property_gradient_moment(const struct pieces *pieces, struct property_sink *sink)
{
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        double floor = 0;
        const double h = property_width[i], axis = measure_sphere(pieces->dim) / pieces->dim;
        const double sum = axis * measure_support(pieces, kernel_dr, pieces->dim, h, &floor);
        floor = axis * floor + 4 * DBL_EPSILON;
        property_take(sink, fabs(sum + 1), property_bound(1e-13, floor), floor, "h %g", h);
    }
}

void property_width_integral(const struct pieces *pieces, struct property_sink *sink)
{
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        double floor = 0;
        const double h = property_width[i];
        const double unit = measure_sphere(pieces->dim) * h / pieces->dim; /* int W dV = 1: d/h */
        const double sum = unit * measure_support(pieces, kernel_dh, pieces->dim - 1, h, &floor);
        floor = unit * floor + 4 * DBL_EPSILON;
        property_take(sink, fabs(sum), property_bound(1e-13, floor), floor, "h %g", h);
    }
}

static void interval(const struct pieces *pieces, double h, double a, double b,
                     struct property_worst *worst)
{
    const int dim = pieces->dim;
    double floor = 0;
    const double unit = kernel_value(pieces->kernel, 0, h, dim);
    const double sum = measure_between(pieces, kernel_dr, 0, h, a, b, &floor);
    const double difference =
        kernel_value(pieces->kernel, b * h, h, dim) - kernel_value(pieces->kernel, a * h, h, dim);
    /* the ends carry the evaluation's own noise, some 4 times that of a coefficient of 32 */
    floor = floor / unit + 4 * pieces->noise_w / pieces->max_w + 2 * DBL_EPSILON;
    property_keep(worst, fabs(difference - sum) / unit, property_bound(1e-13, floor), floor,
                  "h %g, q %.6g to %.6g", h, a, b);
}

void property_fundamental(const struct pieces *pieces, struct property_sink *sink)
{
    const double *edge = pieces->edge;
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        const double h = property_width[i];
        struct property_worst worst = {0};
        for (int p = 0; p < pieces->n; p++) {
            interval(pieces, h, edge[p], edge[p + 1], &worst);
            if (p > 0)
                interval(pieces, h, (edge[p - 1] + edge[p]) / 2, (edge[p] + edge[p + 1]) / 2,
                         &worst);
        }
        interval(pieces, h, 0, 1, &worst);
        property_take_worst(sink, &worst);
    }
}

/* By parts, the edge's term being zero: int r^m W dV = -1/(m+d) int r^(m+1) dW/dr dV. */
void property_moments(const struct pieces *pieces, struct property_sink *sink)
{
    const int dim = pieces->dim;
    for (int m = 2; m <= 4; m += 2) {
        double floor = 0, slope_floor = 0;
        const double h = property_width[m / 2];
        const double sum = measure_support(pieces, kernel_value, m + dim - 1, h, &floor);
        const double parts =
            -measure_support(pieces, kernel_dr, m + dim, h, &slope_floor) / (m + dim);
        floor = (floor + slope_floor / (m + dim)) / fabs(sum) + 4 * DBL_EPSILON;
        property_take(sink, fabs(parts / sum - 1), property_bound(1e-13, floor), floor,
                      "h %g, moment %d", h, m);
    }
}
