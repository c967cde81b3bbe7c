/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks a user's gradient operator against what it promises. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gradient_study.h"
#include "library.h"
#include "order.h"
#include "sphproof/gradients.h"
#include "worst.h"

enum { LEVELS = 5, SEEDS = 2, PLACE = 80 };

/* Bound and floor of errors that vanish up to rounding, in units of max|f|/h; matrices of
 * disordered clouds lose some digits. */
#define BOUND 1e-9
#define FLOOR 1e-14
/* A measured order scatters and may be this much below the promised one. */
#define ORDER_SLACK 0.2

struct trial {
    sphproof_gradient_operator *gradients;
    void *context;
    int dim;
    const struct sphproof_gradient_promise *promise;
    struct library_figures figures;
    bool refused, no_memory;
};

/* A cloud, a field on it and work arrays for gradients; component a of point i at a * n + i. */
struct sample {
    struct clouds_settings settings;
    struct clouds_cloud cloud;
    bool *inside; /* per point: its support is within the cloud as generated */
    double *f, *exact, *g, *other, *sum; /* f: n; the others n * dim */
    double largest;                      /* max |f| */
};

static void sample_free(struct sample *sample)
{
    free(sample->inside), free(sample->f);
    clouds_free(&sample->cloud);
}

static bool sample_make(struct trial *trial, const struct clouds_settings *settings,
                        enum gradient_function field, struct sample *sample)
{
    *sample = (struct sample){.settings = *settings};
    const enum status status = clouds_make(settings, &sample->cloud, NULL);
    const size_t n = sample->cloud.cloud.points.n, dim = (size_t)settings->dim;
    sample->inside = calloc(n, sizeof *sample->inside);
    sample->f = calloc((1 + 4 * dim) * n, sizeof *sample->f);
    if (status || !sample->inside || !sample->f) {
        trial->no_memory = true;
        return false;
    }
    sample->exact = sample->f + n, sample->g = sample->exact + dim * n;
    sample->other = sample->g + dim * n, sample->sum = sample->other + dim * n;
    for (size_t i = 0; i < n; i++) {
        double x[3] = {0}, slope[3];
        for (size_t a = 0; a < dim; a++) x[a] = sample->cloud.x[a][i];
        sample->f[i] = gradient_study_field(field, settings->dim, x, slope);
        for (size_t a = 0; a < dim; a++) sample->exact[a * n + i] = slope[a];
        sample->largest = fmax(sample->largest, fabs(sample->f[i]));
        sample->inside[i] = clouds_interior(settings, &sample->cloud, i);
    }
    return true;
}

/* The user's gradients of f; components that are not filled stay NaN. */
static void apply(struct trial *trial, const struct sample *sample, const double *f, double *to)
{
    const size_t n = sample->cloud.cloud.points.n;
    struct sphproof_cloud cloud = {
        .dim = trial->dim, .n = n, .volume = sample->cloud.volume, .h = sample->cloud.h};
    double *gradient[3] = {NULL};
    for (int a = 0; a < trial->dim; a++) {
        cloud.x[a] = sample->cloud.x[a];
        gradient[a] = to + (size_t)a * n;
        for (size_t i = 0; i < n; i++) gradient[a][i] = (double)NAN;
    }
    if (!trial->gradients(trial->context, &cloud, f, gradient)) trial->refused = true;
}

/* Largest |a - b| h / max|f| of the interior points. */
static double difference(const struct sample *sample, const double *a, const double *b)
{
    const size_t n = sample->cloud.cloud.points.n;
    double worst = 0;
    for (size_t k = 0; k < n * (size_t)sample->settings.dim; k++)
        if (sample->inside[k % n])
            worst_keep(&worst, fabs(a[k] - b[k]) * sample->cloud.h[k % n] / sample->largest);
    return worst;
}

static void tell(struct trial *trial, const char *property, const char *formula, const char *where,
                 double value, double bound)
{
    const struct sphproof_figure figure = {.property = property,
                                           .formula = formula,
                                           .where = where,
                                           .value = value,
                                           .bound = bound,
                                           .floor = FLOOR,
                                           .passed = value <= bound};
    library_figure(&trial->figures, &figure);
}

static struct clouds_settings settings_of(const struct trial *trial, enum clouds_kind kind)
{
    struct clouds_settings settings = gradient_study_cloud(kind, trial->dim);
    settings.eta = trial->promise->eta;
    return settings;
}

static void check_exactness(struct trial *trial)
{
    static const enum gradient_function fields[] = {FUNCTION_CONSTANT, FUNCTION_LINEAR};
    for (int degree = 0; degree < trial->promise->exact; degree++)
        for (int kind = 0; kind < CLOUDS_KINDS && !trial->no_memory; kind++) {
            const struct clouds_settings settings = settings_of(trial, (enum clouds_kind)kind);
            struct sample sample;
            char where[PLACE];
            if (sample_make(trial, &settings, fields[degree], &sample)) {
                apply(trial, &sample, sample.f, sample.g);
                snprintf(where, sizeof where, "%dD, %s, %s field", trial->dim,
                         clouds_name(settings.kind), gradient_study_field_name(fields[degree]));
                tell(trial, "exactness", "|grad f - exact| h/max|f| of polynomials", where,
                     difference(&sample, sample.g, sample.exact), BOUND);
            }
            sample_free(&sample);
        }
}

/* Rms error of a smooth field in the interior, over a few disordered clouds. */
static double smooth_error(struct trial *trial, size_t side)
{
    double sum = 0, count = 0;
    for (unsigned long seed = 0; seed < SEEDS && !trial->no_memory; seed++) {
        const struct clouds_settings settings = {CLOUDS_JITTERED,     trial->dim,  side, 0.2,
                                                 trial->promise->eta, 5 + 3 * seed};
        struct sample sample;
        if (sample_make(trial, &settings, FUNCTION_SMOOTH, &sample)) {
            const size_t n = sample.cloud.cloud.points.n;
            apply(trial, &sample, sample.f, sample.g);
            for (size_t k = 0; k < n * (size_t)trial->dim; k++) {
                const double error = sample.g[k] - sample.exact[k];
                if (sample.inside[k % n]) sum += error * error, count++;
            }
        }
        sample_free(&sample);
    }
    return sqrt(sum / count);
}

static void check_order(struct trial *trial)
{
    static const size_t sides[3][LEVELS] = {
        {32, 48, 72, 108, 162}, {12, 17, 24, 34, 48}, {10, 12, 14, 17, 20}};
    double spacing[LEVELS], errors[LEVELS];
    struct order_fit fit = {.order = (double)NAN};
    char where[PLACE];
    for (int l = 0; l < LEVELS; l++) {
        spacing[l] = 1 / (double)sides[trial->dim - 1][l];
        errors[l] = smooth_error(trial, sides[trial->dim - 1][l]);
    }
    order_fit(LEVELS, spacing, errors, NULL, &fit, NULL);
    snprintf(where, sizeof where, "%dD, jittered: %s", trial->dim, order_class_name(fit.class));
    tell(trial, "order", "promised - observed order in the spacing, smooth field", where,
         trial->promise->order - fit.order, ORDER_SLACK);
}

/* A rotation that maps no lattice axis to another; -1 in 1D. */
static void rotation_make(int dim, double R[9])
{
    const double c = cos(0.7), s = sin(0.7), e = cos(1.9), t = sin(1.9);
    const double one[9] = {-1}, two[9] = {c, -s, s, c};
    const double three[9] = {c, -s * e, s * t, s, c * e, -c * t, 0, t, e};
    memcpy(R, dim == 1 ? one : dim == 2 ? two : three, 9 * sizeof *R);
}

/* other = R g, where other is 0. */
static void turn(const struct sample *sample, const double *R)
{
    const size_t n = sample->cloud.cloud.points.n, dim = (size_t)sample->settings.dim;
    for (size_t a = 0; a < dim; a++)
        for (size_t b = 0; b < dim; b++)
            for (size_t i = 0; i < n; i++)
                sample->other[a * n + i] += R[a * dim + b] * sample->g[b * n + i];
}

/* Moves the cloud by the matrix R and the shift; gradients must transform by R/unit^2. */
static void check_move(struct trial *trial, const char *property, const char *formula,
                       const double R[9], double unit, const double shift[3])
{
    const struct clouds_settings settings = settings_of(trial, CLOUDS_CLUSTERED);
    double back[9];
    char where[PLACE];
    struct sample sample;
    snprintf(where, sizeof where, "%dD, %s", trial->dim, clouds_name(settings.kind));
    if (sample_make(trial, &settings, FUNCTION_SMOOTH, &sample)) {
        const size_t n = sample.cloud.cloud.points.n;
        apply(trial, &sample, sample.f, sample.g);
        for (int k = 0; k < 9; k++) back[k] = R[k] / (unit * unit);
        turn(&sample, back);
        clouds_transform(&sample.cloud, R, shift);
        for (size_t i = 0; i < n; i++) {
            sample.cloud.h[i] *= unit;
            sample.cloud.volume[i] *= pow(unit, trial->dim);
        }
        apply(trial, &sample, sample.f, sample.sum);
        tell(trial, property, formula, where, difference(&sample, sample.sum, sample.other), BOUND);
    }
    sample_free(&sample);
}

static void check_moves(struct trial *trial)
{
    static const double nowhere[3] = {0}, shift[3] = {3.7, -5.1, 2.3}, unit = 2.385;
    double R[9], one[9] = {0}, scale[9] = {0};
    for (int a = 0; a < trial->dim; a++)
        one[a * trial->dim + a] = 1, scale[a * trial->dim + a] = unit;
    rotation_make(trial->dim, R);
    if (trial->promise->turns)
        check_move(trial, "turns", "gradient in the turned cloud = turned gradient", R, 1, nowhere);
    if (trial->promise->moves)
        check_move(trial, "moves", "gradient in the shifted cloud is the same", one, 1, shift);
    if (trial->promise->scales)
        check_move(trial, "scales", "gradient in the larger cloud is smaller by as much", scale,
                   unit, nowhere);
}

/* Checks that equal inputs give equal outputs, and linearity in the field. */
static void check_field(struct trial *trial)
{
    static const double a = 2.385, b = -0.71;
    const struct clouds_settings settings = settings_of(trial, CLOUDS_SOBOL);
    char where[PLACE];
    struct sample sample;
    snprintf(where, sizeof where, "%dD, %s", trial->dim, clouds_name(settings.kind));
    if (sample_make(trial, &settings, FUNCTION_SMOOTH, &sample)) {
        const size_t n = sample.cloud.cloud.points.n, all = n * (size_t)trial->dim;
        apply(trial, &sample, sample.f, sample.g);
        apply(trial, &sample, sample.f, sample.sum);
        tell(trial, "repeats", "same input, same gradient, bit for bit", where,
             memcmp(sample.g, sample.sum, all * sizeof *sample.g) == 0 ? 0 : 1, 0);
        double *const f =
            sample.exact; /* exact is free: it holds another field, then the sum of both */
        for (size_t i = 0; i < n; i++) f[i] = cos(3 * sample.f[i]);
        apply(trial, &sample, f, sample.other);
        for (size_t k = 0; k < all; k++) sample.other[k] = a * sample.g[k] + b * sample.other[k];
        for (size_t i = 0; i < n; i++) f[i] = a * sample.f[i] + b * f[i];
        apply(trial, &sample, f, sample.sum);
        if (trial->promise->linear)
            tell(trial, "linear", "grad (a f + b g) = a grad f + b grad g", where,
                 difference(&sample, sample.sum, sample.other), BOUND);
    }
    sample_free(&sample);
}

enum sphproof_status sphproof_gradients_check(sphproof_gradient_operator *gradients, void *context,
                                              int dim,
                                              const struct sphproof_gradient_promise *promise,
                                              sphproof_figure_sink *sink, void *sink_context,
                                              struct sphproof_error *error)
{
    struct trial trial = {gradients, context, dim, promise, {sink, sink_context, 0, error},
                          false,     false};
    if (!gradients || dim < 1 || dim > 3)
        return library_fail(error, STATUS_BAD_INPUT, "an operator and dim = 1, 2 or 3 are needed");
    if (!(promise->eta >= 1 && promise->eta <= 6) || promise->exact < 0 || promise->exact > 2 ||
        !isfinite(promise->order))
        return library_fail(error, STATUS_BAD_INPUT,
                            "promise: allowed: eta from 1 to 6, exact from 0 to 2, a finite order");
    check_field(&trial);
    check_exactness(&trial);
    check_moves(&trial);
    check_order(&trial);
    if (trial.no_memory) return library_fail(error, STATUS_ENVIRONMENT, "no memory for a cloud");
    if (trial.refused && !trial.figures.failed)
        return library_fail(error, STATUS_CHECK_FAILED, "the operator says that it could not");
    return trial.figures.failed ? SPHPROOF_CHECK_FAILED : SPHPROOF_OK;
}
