/* SPDX-License-Identifier: GPL-3.0-or-later
 * How the error of a gradient operator depends on resolution and on disorder, at a fixed number of
 * neighbours. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "gradient_forms.h"
#include "order.h"

enum { LEVELS = 5 };

/* Expected orders of each operator in the spacing on a lattice and on a jittered lattice, with
 * cubic_spline at its partition-of-unity width, and in the jitter. A conservative form has an error
 * O(jitter) for a constant, whose gradient grows as 1/h; the difference form has an error O(1) for
 * a linear field. */
static const struct expectation {
    const char *name;
    struct order_gate lattice, jittered, disorder;
} expectations[] = {
    {"standard", {1.85, 2.15, 1.5e-3}, {-1.2, -0.8, 100}, {0.8, 1.2, 8}},
    {"standard_difference", {1.85, 2.15, 1.5e-3}, {-0.25, 0.15, 0.15}, {0.65, 1.25, 0.03}},
    {"ia", {1.85, 2.15, 1.5e-3}, {-1.2, -0.8, 100}, {0.85, 1.15, 8}},
    {"corrected", {1.85, 2.15, 1.5e-3}, {-1.2, -0.8, 100}, {0.85, 1.15, 8}},
    {"linear_exact", {1.85, 2.15, 1.5e-3}, {0.85, 1.25, 0.01}, {0.5, 1.9, 0.003}},
    {"normalised_corrected", {1.85, 2.15, 1.5e-3}, {0.85, 1.25, 0.01}, {0.5, 1.9, 0.003}},
};

/* The expectation of an operator; NULL: none, and the order must be that of its promised
 * exactness. */
static const struct expectation *expectation_of(const struct gradient_subject *subject)
{
    for (size_t i = 0; i < sizeof expectations / sizeof *expectations; i++)
        if (strcmp(expectations[i].name, subject->form->member.name) == 0) return &expectations[i];
    return NULL;
}

/* Rms of |grad - exact| over the interior, mean over seeds. */
static double interior_error(const struct gradient_subject *subject, const struct kernel *kernel,
                             const struct clouds_settings *settings)
{
    struct clouds_settings with_seed = *settings;
    double sum = 0;
    const int seeds = settings->kind == CLOUDS_LATTICE ? 1 : 4;
    for (int k = 0; k < seeds; k++) {
        struct clouds_cloud cloud;
        struct gradient_errors errors;
        with_seed.seed = 5 + 3 * (unsigned long)k;
        enum status status = clouds_make(&with_seed, &cloud, NULL);
        if (!status)
            status = gradient_study_errors(subject, kernel, &with_seed, &cloud, FUNCTION_SMOOTH,
                                           &errors, NULL);
        sum += status ? (double)NAN
                      : errors.interior_rms * errors.interior_rms / (cloud.h[0] * cloud.h[0]);
        clouds_free(&cloud);
    }
    return sqrt(sum / seeds);
}

static void measure_gate(struct check_run *run, const double *spacing, const double *error,
                         const struct order_gate *gate, const char *name, int dim,
                         const char *against)
{
    struct order_fit fit = {.order = (double)NAN};
    order_fit(LEVELS, spacing, error, NULL, &fit, NULL);
    const double middle = 0.5 * (gate->low + gate->high), half = 0.5 * (gate->high - gate->low);
    check_measure(run, fabs(fit.order - middle), half, 0.1 * half,
                  "%s, %dD, %s: order %.2f [%.2f, %.2f] in [%g, %g]", name, dim, against, fit.order,
                  fit.low, fit.high, gate->low, gate->high);
    check_measure(run, error[LEVELS - 1], gate->bound, 1e-3 * gate->bound,
                  "%s, %dD, %s: error at the finest level", name, dim, against);
    double log_spacing[LEVELS], log_error[LEVELS];
    for (int l = 0; l < LEVELS; l++)
        log_spacing[l] = log10(spacing[l]), log_error[l] = log10(error[l]);
    check_series(run, against, LEVELS, log_spacing, log_error);
}

/* The lowest degree that is not exact leaves an error of order -1, 0 or 1 in the spacing for exact
 * = 0, 1, 2. */
static void measure_promise(struct check_run *run, const double *spacing, const double *error,
                            int exact, const char *name, int dim, const char *against)
{
    struct order_fit fit = {.order = (double)NAN};
    order_fit(LEVELS, spacing, error, NULL, &fit, NULL);
    check_measure(run, exact - 1 - fit.order, 0.2, 0.02, "%s, %dD, %s: order %.2f, at least %d",
                  name, dim, against, fit.order, exact - 1);
}

static void errors_over_sides(const struct gradient_subject *s, const struct kernel *kernel,
                              struct clouds_settings settings, double *spacing, double *error)
{
    static const size_t sides[3][LEVELS] = {
        {32, 48, 72, 108, 162}, {12, 17, 24, 34, 48}, {10, 12, 14, 17, 20}};
    for (int l = 0; l < LEVELS; l++) {
        settings.side = sides[settings.dim - 1][l];
        spacing[l] = 1 / (double)settings.side;
        error[l] = interior_error(s, kernel, &settings);
    }
}

static void measure_order_in(struct check_run *run, const struct gradient_subject *s,
                             const struct kernel *kernel, int dim)
{
    static const double jitters[LEVELS] = {0.32, 0.16, 0.08, 0.04, 0.02};
    static const size_t middle[3] = {108, 34, 17};
    const struct expectation *expected = expectation_of(s);
    const char *name = s->form->member.name;
    double spacing[LEVELS], error[LEVELS];
    struct clouds_settings settings = {CLOUDS_LATTICE, dim, 0, 0.2, 2, 0};
    if (dim > 1 && !s->form->corrected) {
        check_skip(run, "%s, %dD, lattice, spacing: no width makes the lattice sums exact", name,
                   dim);
    } else {
        errors_over_sides(s, kernel, settings, spacing, error);
        if (expected)
            measure_gate(run, spacing, error, &expected->lattice, name, dim, "lattice, spacing");
        else
            measure_promise(run, spacing, error, s->form->exact_on_lattice, name, dim,
                            "lattice, spacing");
    }
    settings.kind = CLOUDS_JITTERED;
    errors_over_sides(s, kernel, settings, spacing, error);
    if (!expected) {
        measure_promise(run, spacing, error, s->form->exact, name, dim, "jittered, spacing");
        check_skip(run, "%s, %dD, jitter: no expectation (check/gradient_order.c)", name, dim);
        return;
    }
    measure_gate(run, spacing, error, &expected->jittered, name, dim, "jittered, spacing");
    settings.side = middle[dim - 1];
    for (int l = 0; l < LEVELS; l++) {
        settings.jitter = jitters[l];
        error[l] = interior_error(s, kernel, &settings);
    }
    measure_gate(run, jitters, error, &expected->disorder, name, dim, "jitter");
}

static void measure_order(struct check_run *run, const void *subject, int from, int to)
{
    struct kernel kernel = {0};
    kernel_select(&kernel, "cubic_spline", 5, NULL);
    for (int dim = from; dim <= to && !check_decided(run); dim++)
        measure_order_in(run, subject, &kernel, dim);
}

static void measure_narrow(struct check_run *run, const void *subject)
{
    measure_order(run, subject, 1, 2);
}

static void measure_3d(struct check_run *run, const void *subject)
{
    measure_order(run, subject, 3, 3);
}

static const struct check_mutant order_mutants[] = {
    {"order_identity", "identity for the IA matrix", SUBJECT(ia_without_matrix, NONE)},
    {"order_no_matrix", "linear_exact without its matrix", SUBJECT(linear_without_matrix, NONE)},
    {"order_difference_without", "difference form without subtracting f_i",
     SUBJECT(difference_without, NONE)},
    {"order_shepard_only", "normalised kernel without gradient correction",
     SUBJECT(normalised_without_matrix, NONE)},
    {0},
};

#define PROPERTY                                                                                   \
    "observed order of |grad f - exact|/max|f| in the spacing and in the jitter, eta = 2"

CHECK_DEFINE(gradients, order, 250, .cost = 0.2, .property = PROPERTY,
             .subjects = gradient_subjects, .measure = measure_narrow, .mutants = order_mutants);

/* Takes longer than all other gradient checks together. */
CHECK_DEFINE(gradients, order_3d, 250, .cost = 2, .property = PROPERTY ", in 3D", .slow = true,
             .subjects = gradient_subjects, .measure = measure_3d, .mutants = order_mutants);
