/* SPDX-License-Identifier: GPL-3.0-or-later
 * Orders: on synthetic errors whose order, noise and class are known. The interval is judged by its
 * coverage: over many noisy ladders it must hold the true order in 95 % of them. */
#include "order.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>

#include "check.h"

enum { LEVELS = 5, LADDERS = 4000 };

typedef enum status fit_function(size_t n, const double *spacing, const double *error,
                                 const double *variance, struct order_fit *fit,
                                 struct error *failure);

struct fit_subject {
    fit_function *fit;
};

/* error = 0.3 spacing^order exp(noise), noise normal. */
static void noisy_ladder(gsl_rng *rng, double order, double noise, double *spacing, double *error)
{
    for (int i = 0; i < LEVELS; i++) {
        spacing[i] = 0.1 * pow(0.5, i);
        error[i] = 0.3 * pow(spacing[i], order) * exp(gsl_ran_gaussian(rng, noise));
    }
}

static void measure_coverage(struct check_run *run, fit_function *fit, double noise,
                             double variance)
{
    const double order = 1.37;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double spacing[LEVELS], error[LEVELS], variances[LEVELS], mean = 0;
    int covered = 0;
    for (int i = 0; i < LEVELS; i++) variances[i] = variance;
    gsl_rng_set(rng, 2385);
    for (int l = 0; l < LADDERS; l++) {
        struct order_fit got;
        noisy_ladder(rng, order, noise, spacing, error);
        fit(LEVELS, spacing, error, variance > 0 ? variances : NULL, &got, NULL);
        covered += got.low <= order && order <= got.high;
        mean += got.order / LADDERS;
    }
    gsl_rng_free(rng);
    /* Three standard errors of a proportion and of a mean: noise the ladders cannot resolve. */
    const double proportion = 3 * sqrt(0.95 * 0.05 / LADDERS);
    const double slope = 3 * noise / (log(2) * sqrt(10)) / sqrt(LADDERS);
    if (!(variance > 0))
        check_measure(run, fabs((double)covered / LADDERS - 0.95), 1.5 * proportion, proportion,
                      "share of intervals that miss the order, noise %g", noise);
    check_measure(run, fabs(mean - order), 1.5 * slope, slope, "mean order, noise %g%s", noise,
                  variance > 0 ? ", with variances" : "");
}

static void measure_order(struct check_run *run, const void *subject)
{
    static const struct fit_subject right = {order_fit};
    fit_function *fit = (subject ? (const struct fit_subject *)subject : &right)->fit;
    const double spacing[] = {0.3, 0.17, 0.08, 0.05, 0.021};
    double error[LEVELS];
    struct order_fit got;
    for (int p = 1; p <= 4; p++) {
        for (int i = 0; i < LEVELS; i++) error[i] = 2.385 * pow(spacing[i], 0.5 * p);
        fit(LEVELS, spacing, error, NULL, &got, NULL);
        check_measure(run, fabs(got.order - 0.5 * p), 1e-13, 2e-15, "exact power %g", 0.5 * p);
        check_measure(run, got.high - got.low, 1e-12, 4e-14, "its interval");
    }
    measure_coverage(run, fit, 0.05, 0);
    measure_coverage(run, fit, 0.05, 0.0025);
    error[2] = (double)NAN;
    fit(LEVELS, spacing, error, NULL, &got, NULL);
    check_measure(run, !isnan(got.order) + !isnan(got.high), 0, 0, "a NaN at one level");
}

static enum status best_pair(size_t n, const double *spacing, const double *error,
                             const double *variance, struct order_fit *fit, struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, variance, fit, failure);
    for (size_t i = 0; i + 1 < n; i++) fit->order = fmax(fit->order, fit->pairwise[i]);
    return status;
}

/* Scales the interval about the order. */
static enum status rescaled(size_t n, const double *spacing, const double *error,
                            const double *variance, struct order_fit *fit, struct error *failure,
                            double factor)
{
    const enum status status = order_fit(n, spacing, error, variance, fit, failure);
    const double half = (fit->high - fit->low) / 2 * factor;
    fit->low = fit->order - half;
    fit->high = fit->order + half;
    return status;
}

static enum status normal_interval(size_t n, const double *spacing, const double *error,
                                   const double *variance, struct order_fit *fit,
                                   struct error *failure)
{
    return rescaled(n, spacing, error, variance, fit, failure, 1.959964 / 3.182446);
}

static enum status one_standard_error(size_t n, const double *spacing, const double *error,
                                      const double *variance, struct order_fit *fit,
                                      struct error *failure)
{
    return rescaled(n, spacing, error, variance, fit, failure, 1 / 3.182446);
}

/* The residual variance divided by n, not by n - 2. */
static enum status biased_variance(size_t n, const double *spacing, const double *error,
                                   const double *variance, struct order_fit *fit,
                                   struct error *failure)
{
    return rescaled(n, spacing, error, variance, fit, failure, sqrt(3. / 5));
}

static enum status against_number(size_t n, const double *spacing, const double *error,
                                  const double *variance, struct order_fit *fit,
                                  struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, variance, fit, failure);
    fit->order /= 2; /* two dimensions: N for N^(1/2) */
    return status;
}

static enum status drops_nan(size_t n, const double *spacing, const double *error,
                             const double *variance, struct order_fit *fit, struct error *failure)
{
    double s[LEVELS], e[LEVELS];
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        if (!isnan(error[i])) s[kept] = spacing[i], e[kept++] = error[i];
    return order_fit(kept, s, e, kept == n ? variance : NULL, fit, failure);
}

static const struct check_mutant order_mutants[] = {
    {"order_best_pair", "the best of the pairwise orders", &(struct fit_subject){best_pair}},
    {"order_interval_normal", "interval without Student's t",
     &(struct fit_subject){normal_interval}},
    {"order_interval_one_sigma", "interval of one standard error",
     &(struct fit_subject){one_standard_error}},
    {"order_variance_biased", "residual variance divided by n",
     &(struct fit_subject){biased_variance}},
    {"order_against_n", "slope against N, not N^(1/d)", &(struct fit_subject){against_number}},
    {"order_drops_nan", "levels that are NaN left out", &(struct fit_subject){drops_nan}},
    {0},
};

const struct check check_norms_order = {
    .group = "norms",
    .name = "order",
    .property = "slope of log error against log spacing; its 95 % interval covers in 95 % of cases",
    .measure = measure_order,
    .mutants = order_mutants,
};

typedef bool gate_function(const struct order_fit *fit, const struct order_gate *gate, char *why);

struct gate_subject {
    gate_function *passes;
};

static void measure_gate(struct check_run *run, const void *subject)
{
    static const struct gate_subject right = {order_passes};
    gate_function *passes = (subject ? (const struct gate_subject *)subject : &right)->passes;
    const double nan = (double)NAN, inf = (double)INFINITY;
    const struct order_gate gate = {0.9, 1.05, 2e-3};
    const struct {
        const char *what;
        bool expected;
        struct order_fit fit;
    } cases[] = {
        {"inside, narrow, small", true, {.order = 1, .low = 0.95, .high = 1.05, .finest = 1e-3}},
        {"on every limit", true, {.order = 1.05, .low = 0.9, .high = 1.2, .finest = 2e-3}},
        {"order too low", false, {.order = 0.89, .low = 0.85, .high = 0.93, .finest = 1e-3}},
        {"order too high", false, {.order = 1.06, .low = 1.05, .high = 1.07, .finest = 1e-3}},
        {"interval too wide", false, {.order = 1, .low = 0.84, .high = 1.16, .finest = 1e-3}},
        {"error too large", false, {.order = 1, .low = 0.99, .high = 1.01, .finest = 2.1e-3}},
        {"all NaN", false, {.order = nan, .low = nan, .high = nan, .finest = nan}},
        {"order NaN", false, {.order = nan, .low = 0.99, .high = 1.01, .finest = 1e-3}},
        {"interval NaN", false, {.order = 1, .low = nan, .high = 1.01, .finest = 1e-3}},
        {"error NaN", false, {.order = 1, .low = 0.99, .high = 1.01, .finest = nan}},
        {"interval infinite", false, {.order = 1, .low = -inf, .high = inf, .finest = 1e-3}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_measure(run, passes(&cases[i].fit, &gate, NULL) != cases[i].expected, 0, 0, "%s",
                      cases[i].what);
}

static bool gate_passes_nan(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    (void)why;
    return !(fit->order < gate->low || fit->order > gate->high ||
             fit->high - fit->low > 2 * ORDER_HALF_WIDTH_MAX || fit->finest > gate->bound);
}

static bool gate_without_width(const struct order_fit *fit, const struct order_gate *gate,
                               char *why)
{
    (void)why;
    return gate->low <= fit->order && fit->order <= gate->high && fit->finest <= gate->bound;
}

static bool gate_without_bound(const struct order_fit *fit, const struct order_gate *gate,
                               char *why)
{
    (void)why;
    return gate->low <= fit->order && fit->order <= gate->high &&
           fit->high - fit->low <= 2 * ORDER_HALF_WIDTH_MAX;
}

static bool gate_one_sided(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    struct order_gate open = *gate;
    open.high = (double)INFINITY;
    return order_passes(fit, &open, why);
}

static bool gate_by_overlap(const struct order_fit *fit, const struct order_gate *gate, char *why)
{
    (void)why;
    return fit->low <= gate->high && fit->high >= gate->low && fit->finest <= gate->bound;
}

static const struct check_mutant gate_mutants[] = {
    {"gate_passes_nan", "comparisons written so that NaN passes",
     &(struct gate_subject){gate_passes_nan}},
    {"gate_without_width", "any interval is good enough",
     &(struct gate_subject){gate_without_width}},
    {"gate_without_bound", "any error at the finest level is good enough",
     &(struct gate_subject){gate_without_bound}},
    {"gate_one_sided", "an order too high passes", &(struct gate_subject){gate_one_sided}},
    {"gate_by_overlap", "the interval only has to touch the gate",
     &(struct gate_subject){gate_by_overlap}},
    {0},
};

const struct check check_norms_gate = {
    .group = "norms",
    .name = "gate",
    .property = "order inside AND half-width <= 0.15 AND finest error <= bound; NaN fails",
    .measure = measure_gate,
    .mutants = gate_mutants,
};

typedef struct order_extrapolation extrapolate_function(const double spacing[3],
                                                        const double value[3]);

struct extrapolate_subject {
    extrapolate_function *extrapolate;
};

static void measure_richardson(struct check_run *run, const void *subject)
{
    static const struct extrapolate_subject right = {order_extrapolate};
    extrapolate_function *extrapolate =
        (subject ? (const struct extrapolate_subject *)subject : &right)->extrapolate;
    /* NASA Glenn's worked example, to its printed digits. */
    struct order_extrapolation got =
        extrapolate((double[]){4, 2, 1}, (double[]){0.96178, 0.96854, 0.97050});
    check_measure(run, fabs(got.order - 1.786170), 5e-7, 5e-7, "NASA's example, order");
    check_measure(run, fabs(got.value - 0.9713003), 5e-8, 5e-8, "NASA's example, extrapolated");
    check_measure(run, fabs(100 * got.gci_fine - 0.103083), 5e-7, 5e-7, "NASA's example, GCI12");
    check_measure(run, fabs(100 * got.gci_coarse - 0.356249), 5e-7, 5e-7, "NASA's example, GCI23");

    const double ladders[][3] = {{0.09, 0.03, 0.01}, {0.1, 0.06, 0.025}, {1. / 99, 1. / 198, 1e-3}};
    const double orders[] = {0.6, 1, 2.3}, limit = 2.385, slope = -0.7;
    for (int l = 0; l < 3; l++)
        for (int p = 0; p < 3; p++) {
            double value[3];
            for (int i = 0; i < 3; i++) value[i] = limit + slope * pow(ladders[l][i], orders[p]);
            got = extrapolate(ladders[l], value);
            check_measure(run, fabs(got.order - orders[p]), 1e-8, 1e-9,
                          "order %g of f0 + c h^p on spacings %g %g %g", orders[p], ladders[l][0],
                          ladders[l][1], ladders[l][2]);
            check_measure(run, fabs(got.value - limit), 1e-11, 1e-12, "its limit");
            check_measure(run, fabs(got.gci_fine * value[2] / 1.25 / fabs(limit - value[2]) - 1),
                          1e-8, 1e-9, "its GCI: 1.25 times the true error");
        }
    got = extrapolate((double[]){4, 2, 1}, (double[]){1, 2, 1.5});
    check_measure(run, got.class != ORDER_OSCILLATING || !isnan(got.value), 0, 0, "oscillating");
    got = extrapolate((double[]){4, 2, 1}, (double[]){1, 2, 4});
    check_measure(run, got.class != ORDER_DIVERGING || !isnan(got.value), 0, 0, "diverging");
}

static struct order_extrapolation ratio_two(const double spacing[3], const double value[3])
{
    (void)spacing;
    return order_extrapolate((double[]){4, 2, 1}, value);
}

static struct order_extrapolation without_safety(const double spacing[3], const double value[3])
{
    struct order_extrapolation e = order_extrapolate(spacing, value);
    e.gci_fine /= 1.25;
    e.gci_coarse /= 1.25;
    return e;
}

static struct order_extrapolation wrong_way(const double spacing[3], const double value[3])
{
    struct order_extrapolation e = order_extrapolate(spacing, value);
    e.value = 2 * value[2] - e.value;
    return e;
}

static struct order_extrapolation absolute_ratio(const double spacing[3], const double value[3])
{
    const double mirrored[] = {value[1] - fabs(value[1] - value[0]), value[1],
                               value[1] + fabs(value[2] - value[1])};
    return order_extrapolate(spacing, value[1] > value[0] ? mirrored : value);
}

static const struct check_mutant richardson_mutants[] = {
    {"richardson_ratio_two", "every ratio taken for 2", &(struct extrapolate_subject){ratio_two}},
    {"gci_without_safety", "GCI without the factor 1.25",
     &(struct extrapolate_subject){without_safety}},
    {"richardson_sign", "extrapolated away from the limit",
     &(struct extrapolate_subject){wrong_way}},
    {"richardson_absolute", "oscillating values taken for converging",
     &(struct extrapolate_subject){absolute_ratio}},
    {0},
};

const struct check check_norms_richardson = {
    .group = "norms",
    .name = "richardson_gci",
    .property = "f0 + c h^p is extrapolated to f0; GCI = 1.25 times the estimated error",
    .measure = measure_richardson,
    .mutants = richardson_mutants,
};
