/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks orders on synthetic errors of known order, noise and class. The interval is judged by its
 * coverage: over many noisy ladders it must contain the true order in 95 % of them. */
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

/* A kind of synthetic ladder: error = 0.3 spacing^1.37 exp(x), x normal with standard deviation
 * `noise` at the coarsest level and noise/falls at the finest. */
struct ladder_kind {
    double noise, falls;
    size_t replicates;
};
static const double true_order = 1.37;

/* Draws errors (geometric means of the replicates) and the variances that the replicates show. */
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
    /* Floors: three standard errors of a proportion and of a mean over the ladders. Replicates
     * allow one per cent more, because variances estimated from them set uncertain weights. */
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

/* With one noisy level, the weighted fit must do better than an unweighted one. */
static void measure_weights(struct check_run *run, fit_function *fit)
{
    const double spacing[LEVELS] = {1, 0.5, 0.25, 0.125, 0.0625};
    const double error[LEVELS] = {2, 0.5, 0.25, 0.125, 0.0625};
    const double variance[LEVELS] = {0.25, 0.0001, 0.0001, 0.0001, 0.0001};
    struct order_fit got;
    fit(LEVELS, spacing, error, &(struct order_noise){variance, 200}, &got, NULL);
    check_measure(run, fabs(got.order - 1), 0.05, 0.005, "a level whose error may be off by half");
}

/* Levels with little noise that lie on a curve: the interval must contain the scatter about the
 * line, not only the noise of the replicates. */
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

/* Mutant: the residual variance divided by n, not by n - 2. */
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

/* Mutant: Student's t for the levels alone, never narrower than the scatter about the line. */
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

/* Mutant: the variance of one run instead of that of the mean. */
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

/* Mutant: only the replicates' noise, even if the levels are far off the line. */
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

CHECK_DEFINE(
    norms, order, 650, .cost = 0.7,
    .property = "slope of log error against log spacing; its 95 % interval covers in 95 % of cases",
    .measure = measure_order, .mutants = order_mutants);
