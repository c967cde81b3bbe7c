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

static enum order_class classify(const struct order_fit *fit, double ratio)
{
    const double whole = log(fit->coarsest / fit->finest) / log(ratio);
    if (fabs(whole) < ORDER_FLAT) return ORDER_FLOOR_LIMITED;
    if (!(whole > 0)) return ORDER_DIVERGING;
    const size_t last = fit->n - 2;
    double best = fit->pairwise[0];
    bool falls = fit->pairwise[last] > 0;
    for (size_t i = 0; i < last; i++) {
        best = fmax(best, fit->pairwise[i]);
        falls = falls && fit->pairwise[i] > 0;
    }
    /* A floor appears only at the fine end: all errors before it must have fallen. */
    bool fell = true;
    for (size_t i = 0; i + 1 < last; i++) fell = fell && fit->pairwise[i] > 0;
    if (fell && fit->pairwise[last] < best / 3) return ORDER_FLOOR_LIMITED;
    return falls ? ORDER_ASYMPTOTIC : ORDER_OSCILLATING;
}

/* The slope of a straight line through n points, and the half-width of its interval. */
struct line {
    double slope, half;
};

/* Without replicates the scatter about the line is the only measure of noise. scatter: chi^2 times
 * what its weights alone make the slope's variance. */
static double half_by_scatter(size_t n, double scatter)
{
    const double freedom = (double)(n - 2);
    return gsl_cdf_tdist_Pinv(0.975, freedom) * sqrt(scatter / freedom);
}

/* With replicates, the slope is sum c_i y_i and its variance sum c_i^2 s_i^2, with the degrees of
 * freedom of Satterthwaite (Biometrics Bull. 2, 110, 1946) and Welch (1947). */
static double half_by_replicates(size_t n, const double *x, const double *weight,
                                 const struct order_noise *noise)
{
    double sum = 0, centre = 0, squares = 0, total = 0, parts = 0;
    for (size_t i = 0; i < n; i++) sum += weight[i], centre += weight[i] * x[i];
    centre /= sum;
    for (size_t i = 0; i < n; i++) squares += weight[i] * (x[i] - centre) * (x[i] - centre);
    for (size_t i = 0; i < n; i++) {
        const double c = weight[i] * (x[i] - centre) / squares, part = c * c * noise->variance[i];
        total += part;
        parts += part * part / (double)(noise->replicates - 1);
    }
    return gsl_cdf_tdist_Pinv(0.975, total * total / parts) * sqrt(total);
}

/* Weights 1/variance; a variance from few replicates is shrunk towards the mean of all, because
 * otherwise a level whose replicates agree by accident would have all the weight. false: no noise
 * at all. */
static bool weigh(size_t n, const struct order_noise *noise, double *weight)
{
    const double known = (double)(noise->replicates - 1), drawn = 24; /* by simulation: orders.c */
    double mean = 0;
    for (size_t i = 0; i < n; i++) mean += noise->variance[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        weight[i] = (known + drawn) / (known * noise->variance[i] + drawn * mean);
    return mean > 0;
}

static struct line fit_line(size_t n, const double *x, const double *y,
                            const struct order_noise *noise)
{
    double weight[ORDER_LEVELS_MAX], c0, c1, cov00, cov01, cov11, chi2;
    const bool noisy = noise && weigh(n, noise, weight);
    for (size_t i = 0; i < n && !noisy; i++) weight[i] = 1;
    gsl_fit_wlinear(x, 1, weight, 1, y, 1, n, &c0, &c1, &cov00, &cov01, &cov11, &chi2);
    const double scatter = half_by_scatter(n, cov11 * chi2);
    if (!noisy) return (struct line){c1, scatter};
    /* If levels deviate from the line by more than their noise explains (an F test at 1 %), the
     * rest is curvature, which the scatter of replicates does not contain. */
    const double freedom = (double)(n - 2), known = (double)(n * (noise->replicates - 1));
    const bool curved = gsl_cdf_fdist_Q(chi2 / freedom, freedom, known) < 0.01;
    const double half = half_by_replicates(n, x, weight, noise);
    return (struct line){c1, curved ? fmax(half, scatter) : half};
}

enum status order_fit(size_t n, const double *spacing, const double *error,
                      const struct order_noise *noise, struct order_fit *fit, struct error *failure)
{
    if (n < ORDER_LEVELS_MIN || n > ORDER_LEVELS_MAX)
        return error_set(failure, STATUS_BAD_INPUT,
                         "an order needs %d to %d resolutions, there are %zu", ORDER_LEVELS_MIN,
                         ORDER_LEVELS_MAX, n);
    double x[ORDER_LEVELS_MAX], y[ORDER_LEVELS_MAX];
    bool sound = true;
    for (size_t i = 0; i < n; i++) {
        if (!(spacing[i] > 0 && (i == 0 || spacing[i] < spacing[i - 1])))
            return error_set(failure, STATUS_BAD_INPUT,
                             "resolutions must be distinct and grow: spacing %zu is %g", i,
                             spacing[i]);
        x[i] = log(spacing[i]);
        y[i] = log(error[i]);
        sound = sound && isfinite(y[i]) && (!noise || isfinite(noise->variance[i]));
    }
    *fit = (struct order_fit){.order = NAN, .low = NAN, .high = NAN, .n = n};
    fit->coarsest = error[0];
    fit->finest = error[n - 1];
    for (size_t i = 0; i + 1 < n; i++)
        fit->pairwise[i] = sound ? (y[i + 1] - y[i]) / (x[i + 1] - x[i]) : (double)NAN;
    fit->class = sound ? classify(fit, spacing[0] / spacing[n - 1]) : ORDER_DIVERGING;
    if (!sound) return STATUS_OK;
    const struct line line = fit_line(n, x, y, noise);
    fit->order = line.slope;
    fit->low = line.slope - line.half;
    fit->high = line.slope + line.half;
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
    return !*text;
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
    int state = gsl_root_fsolver_set(solver, &function, 1e-3, 30);
    if (state == GSL_SUCCESS) state = GSL_CONTINUE;
    while (state == GSL_CONTINUE) {
        state = gsl_root_fsolver_iterate(solver);
        p = gsl_root_fsolver_root(solver);
        if (state == GSL_SUCCESS)
            state = gsl_root_test_interval(gsl_root_fsolver_x_lower(solver),
                                           gsl_root_fsolver_x_upper(solver), 0, 1e-14);
    }
    gsl_root_fsolver_free(solver);
    gsl_set_error_handler(handler);
    return p;
}

/* The class of three values whose differences suggest the order p (NaN: none) but that do not
 * approach the exact value as these suggest. */
static enum order_class class_by_errors(const double spacing[3], const double value[3],
                                        double exact, double p)
{
    const double error[3] = {fabs(value[0] - exact), fabs(value[1] - exact),
                             fabs(value[2] - exact)};
    const double last = log(error[1] / error[2]) / log(spacing[1] / spacing[2]);
    const double whole = log(error[0] / error[2]) / log(spacing[0] / spacing[2]);
    if (fabs(whole) < ORDER_FLAT) return ORDER_FLOOR_LIMITED;
    /* the values are monotonic: if the last step is towards the exact value, so is the first */
    if (!(last > 0)) return whole > 0 && isfinite(p) ? ORDER_OSCILLATING : ORDER_DIVERGING;
    return last < p / 3 ? ORDER_FLOOR_LIMITED : ORDER_PREASYMPTOTIC;
}

struct order_extrapolation order_extrapolate(const double spacing[3], const double value[3],
                                             double exact)
{
    struct order_extrapolation result = {NAN, NAN, NAN, NAN, ORDER_DIVERGING};
    const double fine = value[2] - value[1], coarse = value[1] - value[0];
    const double ratio = coarse / fine, round_off = 1e-13 * fabs(value[2]);
    const double safety = 1.25;
    if (!isfinite(fine) || !isfinite(coarse)) return result;
    if (fabs(fine) <= round_off && fabs(coarse) <= round_off) result.class = ORDER_FLOOR_LIMITED;
    if (!isfinite(ratio) || result.class == ORDER_FLOOR_LIMITED) return result;
    if (!(ratio > 0)) {
        result.class = ORDER_OSCILLATING;
        return result;
    }
    struct richardson r = {log(spacing[1] / spacing[2]), log(spacing[0] / spacing[1]), log(ratio)};
    const double p = richardson_order(&r);
    const double gci = safety * fabs(fine / value[2]) / expm1(r.fine * p);
    const double error = fabs(value[2] - exact);
    const bool reached = error <= gci * fabs(value[2]) + round_off;
    const bool falls = error < fabs(value[1] - exact) || error <= round_off;
    if (!isnan(exact) && !(isfinite(p) && reached && falls)) {
        result.class = class_by_errors(spacing, value, exact, p);
        return result;
    }
    if (!isfinite(p)) return result;
    result.class = ORDER_ASYMPTOTIC;
    result.order = p;
    result.value = value[2] + fine / expm1(r.fine * p);
    result.gci_fine = gci;
    result.gci_coarse = safety * fabs(coarse / value[1]) / expm1(r.coarse * p);
    return result;
}
