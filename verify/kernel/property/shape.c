/* SPDX-License-Identifier: GPL-3.0-or-later
 * Support, signs, self-term and continuity. */
#include <float.h>
#include <math.h>

#include "measure.h"
#include "property.h"

/* A position just inside the support, at which even exp(-1/(1-q^2)) is not yet rounded to 0. */
static const double inside = 0.9992;

/* Positions from the edge on, including the next number above 1, and far beyond it, but not so far
 * that the polynomial factor of (1 - q)+ overflows. */
static const double outside[] = {1,    1 + 0x1p-52, 1 + 1e-12, 1 + 1e-8, 1.0001, 1.001, 1.01,
                                 1.05, 1.1,         1.2,       1.25,     1.5,    1.75,  2,
                                 2.5,  3,           4.75,      10,       100,    1e6,   1e25};

/* At and beyond the edge; a kernel of class C0 may return its one-sided slope at q = 1 itself. */
void property_support(const struct pieces *pieces, struct property_sink *sink)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        const double h = property_width[i], unit = pow(h, dim);
        struct property_worst worst = {0};
        for (size_t j = 0; j < sizeof outside / sizeof *outside; j++) {
            double r = outside[j] * h;
            while (r / h < outside[j]) r = nextafter(r, (double)INFINITY);
            property_keep(&worst, fabs(kernel_value(kernel, r, h, dim)) * unit, 0, 0,
                          "h %g, W at q = %.17g", h, r / h);
            if (kernel->smoothness[dim] == 0 && outside[j] == 1) continue;
            property_keep(&worst, fabs(kernel_dr(kernel, r, h, dim)) * unit * h, 0, 0,
                          "h %g, h dW/dr at q = %.17g", h, r / h);
            property_keep(&worst, fabs(kernel_dh(kernel, r, h, dim)) * unit * h, 0, 0,
                          "h %g, h dW/dh at q = %.17g", h, r / h);
        }
        property_take_worst(sink, &worst);
    }
    double floor;
    const double last = pieces_derivative(pieces, 1, pieces->edge[pieces->n - 1], 0, &floor);
    property_take(sink, fabs(last), measure_significant * floor, floor,
                  "w = %.3g just inside the edge: it must go to 0 there", last);
    const bool reaches = kernel->w(kernel, inside, dim) != 0;
    property_take(sink, reaches ? 0 : 1, 0, 0, "w(%g) = 0: the support ends before q = 1", inside);
}

/* Between its points a table's interpolation may ripple: by (1/n)^4 in w, (1/n)^3 in dw. */
static double ripple(const struct pieces *pieces, double factor, int exponent)
{
    enum { FEW = 8 };
    return pieces->n > FEW ? factor * pow(pieces->n, -exponent) : 0;
}

void property_sign(const struct pieces *pieces, struct property_sink *sink)
{
    enum { SAMPLES = 64 };
    const struct kernel *kernel = pieces->kernel;
    struct property_worst value = {0}, slope = {0};
    double least = 0, steepest = 0;
    for (int p = 0; p < pieces->n; p++)
        for (int i = 0; i < SAMPLES; i++) {
            const double a = pieces->edge[p], b = pieces->edge[p + 1];
            const double q = a + (b - a) * i / SAMPLES;
            const double w = kernel->w(kernel, q, pieces->dim) / pieces->max_w;
            const double dw = kernel->dw(kernel, q, pieces->dim) / pieces->max_dw;
            const double floor = 2 * pieces->epsilon;
            least = fmin(least, w);
            steepest = fmax(steepest, dw);
            property_keep(&value, isnan(w) ? w : fmax(0, -w), 8 * floor + ripple(pieces, 2, 4),
                          floor, "W/W(0) < 0 at q = %.6g", q);
            property_keep(&slope, isnan(dw) ? dw : fmax(0, dw), 8 * floor + ripple(pieces, 10, 3),
                          floor, "dW/dr > 0 at q = %.6g", q);
        }
    if (pieces->terms.negative) {
        property_skip(sink, "declared negative: least w/max|w| = %.3g, largest dw/max|dw| = %.3g",
                      least, steepest);
        return;
    }
    property_take_worst(sink, &value);
    property_take_worst(sink, &slope);
}

void property_self_term(const struct pieces *pieces, struct property_sink *sink)
{
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    const double w0 = kernel->constant[dim] * kernel->w(kernel, 0, dim), floor = DBL_EPSILON;
    const double slope = fabs(kernel->dw(kernel, 0, dim)) / pieces->max_dw;
    struct property_worst worst = {0};
    for (int i = 0; i < PROPERTY_WIDTHS; i++) {
        const double h = property_width[i], value = kernel_value(kernel, 0, h, dim);
        property_keep(&worst, fabs(value * pow(h, dim) / w0 - 1), 16 * floor, floor,
                      "h %g, W(0) h^d against C_d w(0)", h);
        property_keep(&worst, fabs(kernel_dh(kernel, 0, h, dim) * h / (dim * value) + 1),
                      16 * floor, floor, "h %g, dW/dh(0) against -d W(0)/h", h);
    }
    property_take_worst(sink, &worst);
    if (kernel->smoothness[dim] == 0)
        property_skip(sink, "class C0: the slope at the origin may be one-sided");
    else
        property_take(sink, slope, 16 * floor, floor, "dw(0)/max|dw|");
    const double alone = kernel_value(kernel, 0, kernel_least_eta(kernel, dim), dim);
    property_take(sink, fabs(alone - 1), 32 * floor, floor, "W(0) at the least eta against 1");
    property_take(sink, w0 > 0 && w0 <= DBL_MAX ? 0 : 1, 0, 0, "W(0) = %g must be positive", w0);
}

/* Compares the value at q with the closer of its neighbours' values: a hole is a point to which no
 * branch applies. */
static void look_for_hole(const struct pieces *pieces, kernel_shape *shape, double scale, double q,
                          const char *name, struct property_worst *worst)
{
    const double step = 1e-10;
    const double value = shape(pieces->kernel, q, pieces->dim);
    const double left = shape(pieces->kernel, fabs(q - step), pieces->dim);
    const double right = shape(pieces->kernel, q + step, pieces->dim);
    const double error = fmin(fabs(value - (q < step ? right : left)), fabs(value - right));
    property_keep(worst, isnan(value) ? value : error / scale, 1e-7, 1e-9,
                  "%s at q = %.6g itself against its neighbours", name, q);
}

/* Tests points where a formula may change: the knots, and simple fractions. */
static void look_for_holes(const struct pieces *pieces, struct property_sink *sink)
{
    enum { FRACTIONS = 60 };
    struct property_worst worst = {0};
    for (int i = 0; i <= FRACTIONS + pieces->n; i++) {
        const double q = i <= FRACTIONS ? (double)i / FRACTIONS : pieces->edge[i - FRACTIONS];
        look_for_hole(pieces, pieces->kernel->w, pieces->max_w, q, "w", &worst);
        if (q > 0) look_for_hole(pieces, pieces->kernel->dw, pieces->max_dw, q, "dw", &worst);
    }
    property_take_worst(sink, &worst);
}

void property_continuity(const struct pieces *pieces, struct property_sink *sink)
{
    const int declared = pieces->kernel->smoothness[pieces->dim];
    struct measure_class class;
    measure_class(pieces, &class);
    const int limit = measure_class_limit(pieces);
    for (int k = 0; k <= declared && k <= limit; k++) {
        const struct measure_jump *jump = &class.jump[k];
        const char *place = jump->at == 0 ? "the origin" : jump->at == 1 ? "the edge" : "a knot";
        property_take(sink, jump->jump, measure_significant * jump->floor, jump->floor,
                      "jump of w^(%d) at %s, q = %.6g%s", k, place, jump->at,
                      k == 0 && jump->at == 1 ? ": w must vanish there" : "");
    }
    look_for_holes(pieces, sink);
    property_take(sink, fmax(0, fmin(declared, limit) - class.class), 0, 0,
                  "%s C%d, measured C%d%s", pieces->terms.class_found ? "found" : "declared",
                  declared, class.class, class.class == limit ? " or higher" : "");
    if (class.accident.count)
        property_take(sink, class.accident.count, 0, 0,
                      "w^(%d) jumps by %.2g of its size at q = %.9g: too little to be meant",
                      class.accident.k, class.accident.jump, class.accident.at);
    if (pieces->kernel->knot_count >= 0)
        property_take(sink, class.extra, 0, 0, "knots not declared%s",
                      class.extra ? "" : ": none found");
}
