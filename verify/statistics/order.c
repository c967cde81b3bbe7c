/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "order.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_roots.h>
#include <math.h>
#include <stdio.h>

const char *order_class_name(enum order_class class)
{
    static const char *const names[] = {
#define CLASS(name, text) text,
        ORDER_CLASS_LIST(CLASS)
#undef CLASS
    };
    return names[class];
}

static enum order_class classify(const struct order_fit *fit, double coarsest)
{
    if (!(fit->finest < coarsest)) return ORDER_DIVERGING;
    const size_t last = fit->n - 2;
    double best = fit->pairwise[0];
    bool falls = fit->pairwise[last] > 0;
    for (size_t i = 0; i < last; i++) {
        best = fmax(best, fit->pairwise[i]);
        falls = falls && fit->pairwise[i] > 0;
    }
    /* A floor shows at the fine end only: what went before must have fallen all the way. */
    bool fell = true;
    for (size_t i = 0; i + 1 < last; i++) fell = fell && fit->pairwise[i] > 0;
    if (fell && fit->pairwise[last] < best / 3) return ORDER_FLOOR_LIMITED;
    return falls ? ORDER_ASYMPTOTIC : ORDER_OSCILLATING;
}

enum status order_fit(size_t n, const double *spacing, const double *error, const double *variance,
                      struct order_fit *fit, struct error *failure)
{
    if (n < ORDER_LEVELS_MIN || n > ORDER_LEVELS_MAX)
        return error_set(failure, STATUS_BAD_INPUT,
                         "an order needs %d to %d resolutions, there are %zu", ORDER_LEVELS_MIN,
                         ORDER_LEVELS_MAX, n);
    double x[ORDER_LEVELS_MAX], y[ORDER_LEVELS_MAX], weight[ORDER_LEVELS_MAX];
    bool sound = true;
    for (size_t i = 0; i < n; i++) {
        if (!(spacing[i] > 0 && (i == 0 || spacing[i] < spacing[i - 1])))
            return error_set(failure, STATUS_BAD_INPUT,
                             "resolutions must be distinct and grow: spacing %zu is %g", i,
                             spacing[i]);
        x[i] = log(spacing[i]);
        y[i] = log(error[i]);
        weight[i] = variance ? 1 / variance[i] : 1;
        sound = sound && isfinite(y[i]) && isfinite(weight[i]);
    }
    *fit = (struct order_fit){.order = NAN, .low = NAN, .high = NAN, .n = n};
    fit->finest = error[n - 1];
    for (size_t i = 0; i + 1 < n; i++)
        fit->pairwise[i] = sound ? (y[i + 1] - y[i]) / (x[i + 1] - x[i]) : (double)NAN;
    fit->class = sound ? classify(fit, error[0]) : ORDER_DIVERGING;
    if (!sound) return STATUS_OK;

    double c0, c1, cov00, cov01, cov11, chi2;
    gsl_fit_wlinear(x, 1, weight, 1, y, 1, n, &c0, &c1, &cov00, &cov01, &cov11, &chi2);
    /* Without variances the scatter about the line is the only measure of noise; with them it can
     * only widen the interval (curvature is not in the replicates). */
    const double freedom = (double)(n - 2);
    const double scale = variance ? fmax(1, chi2 / freedom) : chi2 / freedom;
    const double half = gsl_cdf_tdist_Pinv(0.975, freedom) * sqrt(cov11 * scale);
    fit->order = c1;
    fit->low = c1 - half;
    fit->high = c1 + half;
    return STATUS_OK;
}

bool order_passes(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    const double half = (fit->high - fit->low) / 2;
    char text[ORDER_GATE_TEXT] = "";
    if (!(gate->low <= fit->order && fit->order <= gate->high))
        snprintf(text, sizeof text, "order %.3f is outside [%g, %g]", fit->order, gate->low,
                 gate->high);
    else if (!(half <= ORDER_HALF_WIDTH_MAX))
        snprintf(text, sizeof text, "order %.3f is known to +-%.3f only, +-%g is allowed",
                 fit->order, half, ORDER_HALF_WIDTH_MAX);
    else if (!(fit->finest <= gate->bound))
        snprintf(text, sizeof text, "finest error %.3g exceeds %.3g", fit->finest, gate->bound);
    if (why) snprintf(why, ORDER_GATE_TEXT, "%s", text);
    return !text[0];
}

struct richardson {
    double fine, coarse; /* logarithms of the ratios of spacings, > 0 */
    double change;       /* log of (coarse - middle)/(middle - fine) */
};

/* f = C h^p: the changes between levels have the ratio r_fine^p (r_coarse^p - 1)/(r_fine^p - 1).
 * Zero at the observed order. */
static double richardson_residual(double p, void *richardson)
{
    const struct richardson *r = richardson;
    return r->fine * p + log(expm1(r->coarse * p) / expm1(r->fine * p)) - r->change;
}

static double richardson_order(struct richardson *r)
{
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    gsl_function function = {richardson_residual, r};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    double p = NAN;
    if (gsl_root_fsolver_set(solver, &function, 1e-3, 30) == GSL_SUCCESS)
        for (int i = 0; i < 100; i++) {
            if (gsl_root_fsolver_iterate(solver)) break;
            p = gsl_root_fsolver_root(solver);
            if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver),
                                       gsl_root_fsolver_x_upper(solver), 0, 1e-14) == GSL_SUCCESS)
                break;
        }
    gsl_root_fsolver_free(solver);
    gsl_set_error_handler(handler);
    return p;
}

struct order_extrapolation order_extrapolate(const double spacing[3], const double value[3])
{
    struct order_extrapolation result = {NAN, NAN, NAN, NAN, ORDER_DIVERGING};
    const double fine = value[2] - value[1], coarse = value[1] - value[0];
    const double ratio = coarse / fine;
    if (!isfinite(ratio)) return result;
    if (!(ratio > 0)) {
        result.class = ORDER_OSCILLATING;
        return result;
    }
    struct richardson r = {log(spacing[1] / spacing[2]), log(spacing[0] / spacing[1]), log(ratio)};
    const double p = richardson_order(&r);
    if (!isfinite(p)) return result;
    const double safety = 1.25;
    result.class = ORDER_ASYMPTOTIC;
    result.order = p;
    result.value = value[2] + fine / expm1(r.fine * p);
    result.gci_fine = safety * fabs(fine / value[2]) / expm1(r.fine * p);
    result.gci_coarse = safety * fabs(coarse / value[1]) / expm1(r.coarse * p);
    return result;
}
