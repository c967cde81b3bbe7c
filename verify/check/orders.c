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
                                 const struct order_noise *noise, struct order_fit *fit,
                                 struct error *failure);

struct fit_subject {
    fit_function *fit;
};

/* What a ladder of synthetic errors is like: error = 0.3 spacing^1.37 exp(noise), noise normal; its
 * deviation at the coarsest level, and that over the one at the finest. */
struct ladder_kind {
    double noise, falls;
    size_t replicates;
};
static const double true_order = 1.37;

/* Errors (geometric means of the replicates), and the variances that the replicates show. */
static void noisy_ladder(gsl_rng *rng, const struct ladder_kind *kind, double *spacing,
                         double *error, double *variance)
{
    const double replicates = (double)kind->replicates;
    for (int i = 0; i < LEVELS; i++) {
        const double sigma = kind->noise * pow(kind->falls, -i / (LEVELS - 1.));
        double sum = 0, squares = 0;
        for (size_t r = 0; r < kind->replicates; r++) {
            const double shift = gsl_ran_gaussian(rng, sigma);
            sum += shift;
            squares += shift * shift;
        }
        spacing[i] = 0.1 * pow(0.5, i);
        error[i] = 0.3 * pow(spacing[i], true_order) * exp(sum / replicates);
        variance[i] = (squares - sum * sum / replicates) / (replicates - 1) / replicates;
    }
}

static void measure_coverage(struct check_run *run, fit_function *fit,
                             const struct ladder_kind *kind)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    double spacing[LEVELS], error[LEVELS], variance[LEVELS], mean = 0;
    const struct order_noise noise = {variance, kind->replicates};
    int covered = 0;
    gsl_rng_set(rng, 2385);
    for (int l = 0; l < LADDERS; l++) {
        struct order_fit got;
        noisy_ladder(rng, kind, spacing, error, variance);
        fit(LEVELS, spacing, error, kind->replicates > 1 ? &noise : NULL, &got, NULL);
        covered += got.low <= true_order && true_order <= got.high;
        mean += got.order / LADDERS;
    }
    gsl_rng_free(rng);
    /* Three standard errors of a proportion and of a mean: noise the ladders cannot resolve. With
     * replicates one percent more: weights are as uncertain as the variances they come from. */
    const double proportion = 3 * sqrt(0.95 * 0.05 / LADDERS);
    const double slope = 3 * kind->noise / (log(2) * sqrt(10)) / sqrt(LADDERS);
    check_measure(run, fabs((double)covered / LADDERS - 0.95),
                  1.5 * proportion + (kind->replicates > 1 ? 0.01 : 0), proportion,
                  "share of intervals that miss the order, noise %g falling %g times, %zu runs",
                  kind->noise, kind->falls, kind->replicates);
    check_measure(run, fabs(mean - true_order), 1.5 * slope, slope,
                  "mean order, noise %g falling %g times, %zu runs", kind->noise, kind->falls,
                  kind->replicates);
}

/* Of levels one of which is noisy the fit must make more than of levels taken for alike. */
static void measure_weights(struct check_run *run, fit_function *fit)
{
    const double spacing[LEVELS] = {1, 0.5, 0.25, 0.125, 0.0625};
    const double error[LEVELS] = {2, 0.5, 0.25, 0.125, 0.0625};
    const double variance[LEVELS] = {0.25, 0.0001, 0.0001, 0.0001, 0.0001};
    struct order_fit got;
    fit(LEVELS, spacing, error, &(struct order_noise){variance, 200}, &got, NULL);
    check_measure(run, fabs(got.order - 1), 0.05, 0.005, "a level whose error may be off by half");
}

/* Replicates know nothing of curvature: levels off the line by far more than their noise. */
static void measure_curved(struct check_run *run, fit_function *fit)
{
    double spacing[LEVELS], error[LEVELS], variance[LEVELS];
    struct order_fit alone, got;
    for (int i = 0; i < LEVELS; i++) {
        spacing[i] = pow(0.5, i);
        error[i] = spacing[i] + 0.5 * spacing[i] * spacing[i];
        variance[i] = 1e-8;
    }
    fit(LEVELS, spacing, error, NULL, &alone, NULL);
    fit(LEVELS, spacing, error, &(struct order_noise){variance, 9}, &got, NULL);
    check_measure(run, fabs((got.high - got.low) / (alone.high - alone.low) - 1), 1e-9, 1e-11,
                  "the interval of a curve with quiet levels is that of its scatter");
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
    static const struct ladder_kind kinds[] = {
        {0.05, 1, 1}, {0.14, 1, 3}, {0.14, 1, 9}, {0.14, 4, 3}, {0.14, 4, 9}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) measure_coverage(run, fit, &kinds[k]);
    measure_weights(run, fit);
    measure_curved(run, fit);
    error[2] = (double)NAN;
    fit(LEVELS, spacing, error, NULL, &got, NULL);
    check_measure(run, !isnan(got.order) + !isnan(got.high), 0, 0, "a NaN at one level");
}

static enum status best_pair(size_t n, const double *spacing, const double *error,
                             const struct order_noise *noise, struct order_fit *fit,
                             struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    for (size_t i = 0; i + 1 < n; i++) fit->order = fmax(fit->order, fit->pairwise[i]);
    return status;
}

/* Scales the interval about the order. */
static enum status rescaled(size_t n, const double *spacing, const double *error,
                            const struct order_noise *noise, struct order_fit *fit,
                            struct error *failure, double factor)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    const double half = (fit->high - fit->low) / 2 * factor;
    fit->low = fit->order - half;
    fit->high = fit->order + half;
    return status;
}

static enum status normal_interval(size_t n, const double *spacing, const double *error,
                                   const struct order_noise *noise, struct order_fit *fit,
                                   struct error *failure)
{
    return rescaled(n, spacing, error, noise, fit, failure, 1.959964 / 3.182446);
}

static enum status one_standard_error(size_t n, const double *spacing, const double *error,
                                      const struct order_noise *noise, struct order_fit *fit,
                                      struct error *failure)
{
    return rescaled(n, spacing, error, noise, fit, failure, 1 / 3.182446);
}

/* The residual variance divided by n, not by n - 2. */
static enum status biased_variance(size_t n, const double *spacing, const double *error,
                                   const struct order_noise *noise, struct order_fit *fit,
                                   struct error *failure)
{
    return rescaled(n, spacing, error, noise, fit, failure, sqrt(3. / 5));
}

static enum status against_number(size_t n, const double *spacing, const double *error,
                                  const struct order_noise *noise, struct order_fit *fit,
                                  struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    fit->order /= 2; /* two dimensions: N for N^(1/2) */
    return status;
}

static enum status drops_nan(size_t n, const double *spacing, const double *error,
                             const struct order_noise *noise, struct order_fit *fit,
                             struct error *failure)
{
    double s[LEVELS], e[LEVELS];
    size_t kept = 0;
    for (size_t i = 0; i < n; i++)
        if (!isnan(error[i])) s[kept] = spacing[i], e[kept++] = error[i];
    return order_fit(kept, s, e, kept == n ? noise : NULL, fit, failure);
}

/* Student's t for the levels alone, and never narrower than the scatter about the line. */
static enum status few_freedoms(size_t n, const double *spacing, const double *error,
                                const struct order_noise *noise, struct order_fit *fit,
                                struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (!noise) return status;
    double sum = 0, squares = 0, mean = 0;
    for (size_t i = 0; i < n; i++) sum += log(spacing[i]) / (double)n;
    for (size_t i = 0; i < n; i++) {
        squares += (log(spacing[i]) - sum) * (log(spacing[i]) - sum);
        mean += noise->variance[i] / (double)n;
    }
    const double half = fmax((fit->high - fit->low) / 2, 3.182446 * sqrt(mean / squares));
    fit->low = fit->order - half;
    fit->high = fit->order + half;
    return status;
}

static enum status unweighted(size_t n, const double *spacing, const double *error,
                              const struct order_noise *noise, struct order_fit *fit,
                              struct error *failure)
{
    (void)noise;
    return order_fit(n, spacing, error, NULL, fit, failure);
}

/* The variance of one run where that of the mean belongs. */
static enum status variance_of_one(size_t n, const double *spacing, const double *error,
                                   const struct order_noise *noise, struct order_fit *fit,
                                   struct error *failure)
{
    double variance[LEVELS];
    for (size_t i = 0; i < n && noise; i++)
        variance[i] = noise->variance[i] * (double)noise->replicates;
    return order_fit(n, spacing, error,
                     noise ? &(struct order_noise){variance, noise->replicates} : NULL, fit,
                     failure);
}

/* The replicates' noise alone, however far the levels are off the line. */
static enum status no_curvature(size_t n, const double *spacing, const double *error,
                                const struct order_noise *noise, struct order_fit *fit,
                                struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (!noise || noise->variance[0] > 1e-6) return status;
    fit->low = fit->order - 4 * sqrt(noise->variance[0]);
    fit->high = fit->order + 4 * sqrt(noise->variance[0]);
    return status;
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
    {"order_few_freedoms", "replicates, but the degrees of freedom of the levels",
     &(struct fit_subject){few_freedoms}},
    {"order_unweighted", "replicates not looked at", &(struct fit_subject){unweighted}},
    {"order_variance_of_one", "variance of a run, not of the mean",
     &(struct fit_subject){variance_of_one}},
    {"order_no_curvature", "curvature taken for nothing where replicates agree",
     &(struct fit_subject){no_curvature}},
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

struct class_subject {
    fit_function *fit;
};

static void measure_class(struct check_run *run, const void *subject)
{
    static const struct class_subject right = {order_fit};
    fit_function *fit = (subject ? (const struct class_subject *)subject : &right)->fit;
    static const double spacing[LEVELS] = {1, 0.5, 0.25, 0.125, 0.0625};
    static const struct {
        enum order_class class;
        double error[LEVELS];
    } cases[] = {
        {ORDER_ASYMPTOTIC, {16, 8, 4, 2, 1}},
        {ORDER_ASYMPTOTIC, {16, 11, 7.6, 5.2, 3.6}},
        {ORDER_FLOOR_LIMITED, {16, 8, 4, 3.6, 3.5}},
        {ORDER_FLOOR_LIMITED, {16, 8, 4, 3.6, 3.7}},
        {ORDER_FLOOR_LIMITED, {5.13, 5.12, 5.11, 5.1, 5.09}}, /* sat there from the start */
        {ORDER_FLOOR_LIMITED, {5.13, 5.13, 5.13, 5.13, 5.13}},
        {ORDER_FLOOR_LIMITED, {5.13, 5.131, 5.13, 5.131, 5.1301}},
        {ORDER_OSCILLATING, {16, 4, 8, 1, 2}},
        {ORDER_DIVERGING, {1, 2, 4, 8, 16}},
        {ORDER_DIVERGING, {4, 2, 1, 0.5, (double)NAN}},
        {ORDER_DIVERGING, {4, (double)NAN, 1, 0.5, 0.25}},
        {ORDER_DIVERGING, {4, 2, 1, 0.5, 0}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double *e = cases[k].error;
        struct order_fit got;
        fit(LEVELS, spacing, e, NULL, &got, NULL);
        check_measure(run, got.class != cases[k].class, 0, 0, "errors %g %g %g %g %g: %s", e[0],
                      e[1], e[2], e[3], e[4], order_class_name(cases[k].class));
    }
}

/* Whatever falls a little, from level to level, converges. */
static enum status floor_converges(size_t n, const double *spacing, const double *error,
                                   const struct order_noise *noise, struct order_fit *fit,
                                   struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    bool falls = true;
    for (size_t i = 1; i < n; i++) falls = falls && error[i] < error[i - 1] && error[i] > 0;
    if (falls) fit->class = ORDER_ASYMPTOTIC;
    return status;
}

static enum status constant_diverges(size_t n, const double *spacing, const double *error,
                                     const struct order_noise *noise, struct order_fit *fit,
                                     struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (!(error[n - 1] < error[0])) fit->class = ORDER_DIVERGING;
    return status;
}

static enum status nan_is_flat(size_t n, const double *spacing, const double *error,
                               const struct order_noise *noise, struct order_fit *fit,
                               struct error *failure)
{
    const enum status status = order_fit(n, spacing, error, noise, fit, failure);
    if (isnan(fit->order)) fit->class = ORDER_FLOOR_LIMITED;
    return status;
}

static const struct check_mutant class_mutants[] = {
    {"class_floor_converges", "errors that hardly fall are called asymptotic",
     &(struct class_subject){floor_converges}},
    {"class_constant_diverges", "errors that stay where they are are called diverging",
     &(struct class_subject){constant_diverges}},
    {"class_of_nan", "a NaN has a class of its own making", &(struct class_subject){nan_is_flat}},
    {0},
};

const struct check check_norms_class = {
    .group = "norms",
    .name = "order_class",
    .property = "errors that fall are asymptotic, those on a floor or NaN are not",
    .measure = measure_class,
    .mutants = class_mutants,
};

typedef struct order_extrapolation extrapolate_function(const double spacing[3],
                                                        const double value[3], double exact);

struct extrapolate_subject {
    extrapolate_function *extrapolate;
};

static void measure_richardson(struct check_run *run, const void *subject)
{
    static const struct extrapolate_subject right = {order_extrapolate};
    extrapolate_function *extrapolate =
        (subject ? (const struct extrapolate_subject *)subject : &right)->extrapolate;
    const double nan = (double)NAN;
    /* NASA Glenn's worked example, to its printed digits. */
    struct order_extrapolation got =
        extrapolate((double[]){4, 2, 1}, (double[]){0.96178, 0.96854, 0.97050}, nan);
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
            got = extrapolate(ladders[l], value, l ? limit : nan);
            check_measure(run, fabs(got.order - orders[p]), 1e-8, 1e-9,
                          "order %g of f0 + c h^p on spacings %g %g %g", orders[p], ladders[l][0],
                          ladders[l][1], ladders[l][2]);
            check_measure(run, fabs(got.value - limit), 1e-11, 1e-12, "its limit");
            check_measure(run, fabs(got.gci_fine * value[2] / 1.25 / fabs(limit - value[2]) - 1),
                          1e-8, 1e-9, "its GCI: 1.25 times the true error");
            check_measure(run, fabs(got.gci_coarse * value[1] / 1.25 / fabs(limit - value[1]) - 1),
                          1e-8, 1e-9, "its coarse GCI: 1.25 times the true error there");
        }
    static const struct {
        const char *what;
        enum order_class class;
        double value[3], exact;
    } cases[] = {
        {"oscillating", ORDER_OSCILLATING, {1, 2, 1.5}, (double)NAN},
        {"diverging", ORDER_DIVERGING, {1, 2, 4}, (double)NAN},
        {"diverging, though the exact value is known", ORDER_DIVERGING, {1, 2, 4}, -1},
        {"one NaN", ORDER_DIVERGING, {1, 2, (double)NAN}, (double)NAN},
        {"one NaN, coarsest", ORDER_DIVERGING, {(double)NAN, 2, 1}, (double)NAN},
        {"infinite", ORDER_DIVERGING, {1, 2, (double)INFINITY}, 3},
        {"no change", ORDER_FLOOR_LIMITED, {2.5, 2.5, 2.5}, 2.5},
        {"changes of round-off", ORDER_FLOOR_LIMITED, {2.5, 2.5 - 1e-15, 2.5 + 1e-15}, (double)NAN},
        {"exact value inside the GCI", ORDER_ASYMPTOTIC, {1.16, 1.04, 1.01}, 1.0005},
        {"converges to a floor", ORDER_FLOOR_LIMITED, {1.16, 1.04, 1.01}, 0.5},
        {"converges to a floor from below", ORDER_FLOOR_LIMITED, {0.84, 0.96, 0.99}, 1.5},
        {"errors fall, changes grow", ORDER_PREASYMPTOTIC, {7, 5, 2}, 1},
        {"errors fall, but not where changes say", ORDER_PREASYMPTOTIC, {2, 1.45, 1.2}, 0.85},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        got = extrapolate((double[]){4, 2, 1}, cases[k].value, cases[k].exact);
        check_measure(
            run, got.class != cases[k].class || isnan(got.value) != (got.class != ORDER_ASYMPTOTIC),
            0, 0, "%s: %s", cases[k].what, order_class_name(cases[k].class));
    }
}

static struct order_extrapolation ratio_two(const double spacing[3], const double value[3],
                                            double exact)
{
    (void)spacing;
    return order_extrapolate((double[]){4, 2, 1}, value, exact);
}

static struct order_extrapolation without_safety(const double spacing[3], const double value[3],
                                                 double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.gci_fine /= 1.25;
    e.gci_coarse /= 1.25;
    return e;
}

static struct order_extrapolation wrong_way(const double spacing[3], const double value[3],
                                            double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.value = 2 * value[2] - e.value;
    return e;
}

static struct order_extrapolation absolute_ratio(const double spacing[3], const double value[3],
                                                 double exact)
{
    const double mirrored[] = {value[1] - fabs(value[1] - value[0]), value[1],
                               value[1] + fabs(value[2] - value[1])};
    return order_extrapolate(spacing, value[1] > value[0] ? mirrored : value, exact);
}

/* The coarse pair's change over the fine pair's ratio. */
static struct order_extrapolation coarse_as_fine(const double spacing[3], const double value[3],
                                                 double exact)
{
    struct order_extrapolation e = order_extrapolate(spacing, value, exact);
    e.gci_coarse *= expm1(e.order * log(spacing[0] / spacing[1])) /
                    expm1(e.order * log(spacing[1] / spacing[2]));
    return e;
}

static struct order_extrapolation exact_unread(const double spacing[3], const double value[3],
                                               double exact)
{
    (void)exact;
    return order_extrapolate(spacing, value, (double)NAN);
}

static const struct check_mutant richardson_mutants[] = {
    {"richardson_ratio_two", "every ratio taken for 2", &(struct extrapolate_subject){ratio_two}},
    {"gci_without_safety", "GCI without the factor 1.25",
     &(struct extrapolate_subject){without_safety}},
    {"richardson_sign", "extrapolated away from the limit",
     &(struct extrapolate_subject){wrong_way}},
    {"gci_coarse_ratio", "the coarse GCI with the fine ratio",
     &(struct extrapolate_subject){coarse_as_fine}},
    {"extrapolation_exact_unread", "what converges to a floor is called asymptotic",
     &(struct extrapolate_subject){exact_unread}},
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
