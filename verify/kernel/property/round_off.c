/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rounding errors. Of a built-in kernel against the same formula in long double; of any other one
 * from the plateau of its Chebyshev series, which is noise. */
#include <float.h>
#include <math.h>

#include "kernel_long.h"
#include "property.h"

/* Error in ULPs: of the value itself where relative = 1, of `scale` where cancellation is part of
 * the formula (relative = 0). */
static double ulps(double got, long double exact, double scale)
{
    return fabs((double)(got - exact)) / (DBL_EPSILON * scale);
}

static void against_long_double(const struct pieces *pieces, kernel_long_shape *long_w,
                                kernel_long_shape *long_dw, struct property_sink *sink)
{
    enum { SAMPLES = 2000 };
    const struct kernel *kernel = pieces->kernel;
    const int dim = pieces->dim;
    struct property_worst value = {0}, slope = {0};
    for (int i = 0; i < SAMPLES; i++) {
        const double q = (i + 0.385) / SAMPLES;
        const long double w = long_w(kernel, q, dim), dw = long_dw(kernel, q, dim);
        property_keep(&value, ulps(kernel->w(kernel, q, dim), w, fabs((double)w)), 40, 0.5,
                      "w at q = %.6g, ULP", q);
        /* dw vanishes at the origin by cancellation */
        property_keep(&slope,
                      ulps(kernel->dw(kernel, q, dim), dw, fmax(fabs((double)dw), pieces->max_dw)),
                      40, 0.5, "dw at q = %.6g, ULP of max |dw|", q);
    }
    property_take_worst(sink, &value);
    property_take_worst(sink, &slope);
}

void property_round_off(const struct pieces *pieces, struct property_sink *sink)
{
    kernel_long_shape *w, *dw;
    kernel_long_find(pieces->kernel->member.name, &w, &dw);
    if (w && !pieces->kernel->plugin_w) {
        against_long_double(pieces, w, dw, sink);
        return;
    }
    /* where break points had to be found, their error looks like noise */
    const double floor = pieces->n > 1 && pieces->kernel->knot_count < 0 ? 500 : 0.5;
    const double bound = floor > 1 ? 100 * floor : 400;
    property_take(sink, pieces->noise_w / (pieces->epsilon * pieces->max_w), bound, floor,
                  "noise of w, ULP of max |w|%s",
                  !pieces->terms.single && pieces_look_single(pieces)
                      ? ": single precision? judge it with --precision single"
                      : "");
    property_take(sink, pieces->noise_dw / (pieces->epsilon * pieces->max_dw), bound, floor,
                  "noise of dw, ULP of max |dw|");
}
