/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradient operators on five kinds of cloud in 1D, 2D and 3D, with exact and with summation
 * volumes: agreement with brute force, polynomial exactness, the assumption of the Integral
 * Approach. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "gradient_forms.h"
#include "worst.h"

/* The promise of the operator of this name, which a wrong one must keep, too. */
static const struct operator_form *promise_of(const struct gradient_subject *subject)
{
    return (const struct operator_form *)family_find(&operator_family, subject->form->member.name);
}

static struct kernel kernel_at(size_t i)
{
    struct kernel kernel = {0};
    kernel_select(&kernel, kernel_family.members[i % kernel_family.n]->name, 5, NULL);
    return kernel;
}

/* ---- brute force ---- */

/* Largest |src - brute force| h / max|f|, over the condition number if there is a matrix. */
static double departure(const struct gradient_subject *subject, const struct kernel *kernel,
                        const struct clouds_cloud *cloud)
{
    const size_t n = cloud->cloud.points.n;
    const int dim = cloud->cloud.points.dim;
    const struct operator_form *right = promise_of(subject);
    double *memory = malloc(4 * n * sizeof *memory), largest = 0, worst = 0;
    struct operator_point *point = malloc(n * sizeof *point);
    double *const gradient[3] = {memory + n, memory + 2 * n, memory + 3 * n};
    bool ok = memory && point;
    for (size_t i = 0; ok && i < n; i++) {
        double x[3] = {0}, unused[3];
        for (int a = 0; a < dim; a++) x[a] = cloud->x[a][i];
        memory[i] = gradient_study_field(FUNCTION_CUBIC, dim, x, unused);
        largest = fmax(largest, fabs(memory[i]));
    }
    ok = ok && !gradient_study_apply(subject, kernel, &cloud->cloud, memory, gradient, point, NULL);
    for (size_t i = 0; ok && i < n; i += n / 40 + 1) {
        double expected[3];
        naive_gradient(right, kernel, NAIVE_NONE, &cloud->cloud, memory, i, expected);
        for (int a = 0; a < dim; a++) {
            const double error = fabs(gradient[a][i] - expected[a]) * cloud->h[i] / largest /
                                 (right->corrected ? point[i].condition : 1);
            worst_keep(&worst, error);
        }
    }
    free(memory), free(point);
    return ok ? worst : (double)NAN;
}

static void measure_brute_force(struct check_run *run, const void *subject)
{
    for (int dim = 1; dim <= 3; dim++)
        for (size_t k = 0; k < kernel_family.n; k++) {
            const enum clouds_kind kind = (enum clouds_kind)((k + (size_t)dim) % CLOUDS_KINDS);
            const struct gradient_subject *s = subject;
            const struct clouds_settings settings = gradient_study_cloud(kind, dim);
            const struct kernel kernel = kernel_at(k);
            struct clouds_cloud cloud;
            const bool periodic = kind <= CLOUDS_JITTERED;
            double value = (double)NAN;
            if (!clouds_make(&settings, &cloud, NULL)) {
                cloud.cloud.points.periodic = periodic;
                for (int a = 0; a < dim; a++) cloud.cloud.points.hi[a] = 1;
                value = departure(s, &kernel, &cloud);
            }
            clouds_free(&cloud);
            check_measure(run, value, 1e-12, 1e-14, "%s, %s, %dD, %s", s->form->member.name,
                          kernel.member.name, dim, clouds_name(kind));
        }
}

/* ---- exactness ---- */

/* The worse error of both kinds of volumes; on a lattice only exact volumes promise anything. */
static enum status errors_of(const struct gradient_subject *subject, size_t kernel_index,
                             enum clouds_kind kind, int dim, enum gradient_function field,
                             struct gradient_errors *worst)
{
    const struct clouds_settings settings = gradient_study_cloud(kind, dim);
    const struct kernel kernel = kernel_at(kernel_index);
    struct gradient_errors exact = {0}, summed;
    struct clouds_cloud cloud;
    enum status status = clouds_make(&settings, &cloud, NULL);
    if (!status)
        status = gradient_study_errors(subject, &kernel, &settings, &cloud, field, &exact, NULL);
    summed = exact;
    if (!status && kind != CLOUDS_LATTICE)
        status = clouds_sum_volumes(&settings, &kernel, &cloud, NULL);
    if (!status && kind != CLOUDS_LATTICE)
        status = gradient_study_errors(subject, &kernel, &settings, &cloud, field, &summed, NULL);
    clouds_free(&cloud);
    if (status) return status;
    *worst = exact;
    worst_keep(&worst->interior, summed.interior);
    worst_keep(&worst->edge, summed.edge);
    worst->condition = fmax(exact.condition, summed.condition);
    return STATUS_OK;
}

/* Measures a field of this degree on one cloud; everywhere: not only in the interior. */
static void measure_degree(struct check_run *run, const struct gradient_subject *s, size_t kernel,
                           enum clouds_kind kind, int dim, enum gradient_function field,
                           bool everywhere)
{
    struct gradient_errors errors;
    const char *name = s->form->member.name, *field_name = gradient_study_field_name(field);
    if (errors_of(s, kernel, kind, dim, field, &errors)) {
        check_measure(run, (double)NAN, 0, 0, "no memory");
        return;
    }
    const double scale = fmax(errors.condition, 1);
    if (errors.inside)
        check_measure(run, errors.interior, 1e-12 * scale, 1e-14 * scale,
                      "%s, %s, %dD, %s, interior", name, field_name, dim, clouds_name(kind));
    else
        check_skip(run, "%s, %s, %dD, %s, interior: no point is that far from the edge", name,
                   field_name, dim, clouds_name(kind));
    if (everywhere)
        check_measure(run, errors.edge, 1e-12 * scale, 1e-14 * scale, "%s, %s, %dD, %s, edge", name,
                      field_name, dim, clouds_name(kind));
}

static void measure_exactness(struct check_run *run, const void *subject)
{
    const struct gradient_subject *s = subject;
    const struct operator_form *promise = promise_of(s);
    size_t kernel = 0;
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = 0; kind < CLOUDS_KINDS; kind++, kernel++)
            for (int field = FUNCTION_CONSTANT; field <= FUNCTION_LINEAR; field++) {
                const bool everywhere = field < promise->exact;
                const bool lattice = kind == CLOUDS_LATTICE && field < promise->exact_on_lattice;
                if (everywhere || lattice)
                    measure_degree(run, s, kernel, (enum clouds_kind)kind, dim,
                                   (enum gradient_function)field, everywhere);
            }
    if (promise->exact == 0 && promise->exact_on_lattice == 0)
        check_skip(run, "%s: promises nothing", s->form->member.name);
}

static const struct check_mutant brute_force_mutants[] = {
    {"gradient_transposed", "B transposed", SUBJECT(normalised, TRANSPOSED)},
    {"gradient_identity", "identity for the IA matrix", SUBJECT(ia, IDENTITY)},
    {"gradient_determinant", "wrong sign on the tau_12 terms of the 3D determinant",
     SUBJECT(ia, DETERMINANT_SIGN)},
    {"gradient_weight_of_ia", "corrected with W for -W'/r", SUBJECT(corrected_weight_of_ia, NONE)},
    {"gradient_corrected_plain", "corrected without its matrix",
     SUBJECT(corrected_without_matrix, NONE)},
    {"gradient_width_1d", "h = eta m/rho in 2D and 3D", SUBJECT(standard, WIDTH_1D)},
    {"gradient_width_of_neighbour", "W at h_j for h_i", SUBJECT(ia, WIDTH_OF_NEIGHBOUR)},
    {"gradient_sign", "gradient with respect to r_j", SUBJECT(standard, SIGN)},
    {"gradient_no_volume", "V missing in the matrix", SUBJECT(ia, NO_VOLUME)},
    {"gradient_short_support", "neighbours up to 0.9 h", SUBJECT(linear_exact, SHORT_SUPPORT)},
    {"gradient_power_of_h", "h^-d in dW/dr", SUBJECT(difference, POWER_OF_H)},
    {"gradient_diagonal", "off-diagonal matrix elements dropped", SUBJECT(linear_exact, DIAGONAL)},
    {"gradient_no_self", "S without j = i", SUBJECT(normalised, SELF_WITHOUT)},
    {"gradient_float", "pairs in single precision", SUBJECT(standard, FLOAT)},
    {"gradient_half", "each pair once", SUBJECT(standard, HALF)},
    {"gradient_normalised_constant", "derivative of S left out",
     SUBJECT(normalised, NO_NORMALISATION_GRADIENT)},
    {0},
};

CHECK_DEFINE(gradients, brute_force, 203, .cost = 0.9,
             .property = "|grad f - brute force in long double| h/max|f| (per condition number)",
             .subjects = gradient_subjects, .measure = measure_brute_force,
             .mutants = brute_force_mutants);

static const struct check_mutant exactness_mutants[] = {
    {"exactness_transposed", "B transposed", SUBJECT(normalised, TRANSPOSED)},
    {"exactness_determinant", "wrong sign on the tau_12 terms of the 3D determinant",
     SUBJECT(linear_exact, DETERMINANT_SIGN)},
    {"exactness_diagonal", "off-diagonal matrix elements dropped", SUBJECT(linear_exact, DIAGONAL)},
    {"exactness_linear_no_difference", "linear_exact without f_i",
     SUBJECT(linear_without_difference, NONE)},
    {"exactness_linear_no_matrix", "linear_exact without its matrix",
     SUBJECT(linear_without_matrix, NONE)},
    {"exactness_difference_without", "difference form without subtracting f_i",
     SUBJECT(difference_without, NONE)},
    {"exactness_shepard_only", "normalised kernel without gradient correction",
     SUBJECT(normalised_without_matrix, NONE)},
    {"exactness_correction_only", "gradient correction without the normalised kernel",
     SUBJECT(corrected_without_normalisation, NONE)},
    {"exactness_normalised_constant", "derivative of S left out",
     SUBJECT(normalised, NO_NORMALISATION_GRADIENT)},
    {"exactness_ia_identity", "identity for the IA matrix", SUBJECT(ia, IDENTITY)},
    {"exactness_no_volume", "V missing in the matrix", SUBJECT(linear_exact, NO_VOLUME)},
    {0},
};

CHECK_DEFINE(gradients, exactness, 250, .cost = 0.9,
             .property = "|grad f - exact| h/max|f| where the operator is exact: constant, linear",
             .subjects = gradient_subjects, .measure = measure_exactness,
             .mutants = exactness_mutants);

/* ---- the assumption of the Integral Approach ---- */

/* For f = a.x + c, ia gives a + f_i C s with s = sum V x W: exact where s = 0, wrong by f_i C s
 * elsewhere. C s is what ia makes of the field 1. */
struct assumption {
    double left;      /* largest |error of the field - f_i C s| h in the interior */
    double error;     /* of the linear field */
    double violation; /* |s|/h */
    double condition;
    size_t inside;
};

static bool assumption_of(const struct gradient_subject *subject, const struct kernel *kernel,
                          const struct clouds_settings *settings, struct assumption *result)
{
    static const struct operator_form moment = {.member = {"moment", "", ""},
                                                .pair_vector = VECTOR_POSITION};
    static const struct gradient_subject moment_subject = {&moment, NAIVE_NONE};
    const int dim = settings->dim;
    struct clouds_cloud cloud;
    *result = (struct assumption){.condition = 1};
    if (clouds_make(settings, &cloud, NULL)) return false;
    const size_t n = cloud.cloud.points.n;
    double *m = malloc(11 * n * sizeof *m), slope[3] = {0};
    struct operator_point *point = malloc(n * sizeof *point);
    double *const one = m, *const f = m + n, *const g1[3] = {m + 2 * n, m + 3 * n, m + 4 * n};
    double *const g[3] = {m + 5 * n, m + 6 * n, m + 7 * n};
    double *const violated[3] = {m + 8 * n, m + 9 * n, m + 10 * n};
    bool ok = m && point;
    for (size_t i = 0; ok && i < n; i++) {
        double x[3] = {0};
        for (int a = 0; a < dim; a++) x[a] = cloud.x[a][i];
        one[i] = 1, f[i] = gradient_study_field(FUNCTION_LINEAR, dim, x, slope);
    }
    ok = ok && !gradient_study_apply(subject, kernel, &cloud.cloud, one, g1, point, NULL) &&
         !gradient_study_apply(subject, kernel, &cloud.cloud, f, g, point, NULL) &&
         !gradient_study_apply(&moment_subject, kernel, &cloud.cloud, one, violated, point, NULL);
    for (size_t i = 0; ok && i < n; i++) {
        if (!clouds_interior(settings, &cloud, i)) continue;
        result->condition = fmax(result->condition, point[i].condition);
        result->inside++;
        for (int a = 0; a < dim; a++) {
            const double error = g[a][i] - slope[a], expected = f[i] * g1[a][i];
            worst_keep(&result->left, fabs(error - expected) * cloud.h[i]);
            worst_keep(&result->error, fabs(error));
            worst_keep(&result->violation, fabs(violated[a][i]) / cloud.h[i]);
        }
    }
    free(m), free(point);
    clouds_free(&cloud);
    return ok;
}

static void measure_assumption(struct check_run *run, const void *subject)
{
    static const struct gradient_subject right = {&ia, NAIVE_NONE};
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = 0; kind < CLOUDS_KINDS; kind++) {
            const char *name = clouds_name((enum clouds_kind)kind);
            const struct clouds_settings settings =
                gradient_study_cloud((enum clouds_kind)kind, dim);
            const struct kernel kernel = kernel_at((size_t)kind + (size_t)dim);
            struct assumption a;
            if (!assumption_of(subject ? subject : &right, &kernel, &settings, &a)) {
                check_measure(run, (double)NAN, 0, 0, "%dD, %s: no memory", dim, name);
                continue;
            }
            if (!a.inside) {
                check_skip(run, "%dD, %s: no point is an h away from the edge", dim, name);
                continue;
            }
            check_measure(run, a.left, 1e-12 * a.condition, 1e-14 * a.condition,
                          "%dD, %s: error of a linear field %.2e, |sum V x W|/h %.2e", dim, name,
                          a.error, a.violation);
            if (kind == CLOUDS_LATTICE)
                check_measure(run, a.violation, 1e-14, 1e-16, "%dD, lattice: |sum V x W|/h", dim);
        }
}

static const struct check_mutant assumption_mutants[] = {
    {"ia_identity", "identity for the IA matrix", SUBJECT(ia, IDENTITY)},
    {"ia_no_volume", "V missing in the matrix", SUBJECT(ia, NO_VOLUME)},
    {"ia_diagonal", "off-diagonal matrix elements dropped", SUBJECT(ia, DIAGONAL)},
    {"ia_float", "pairs in single precision", SUBJECT(ia, FLOAT)},
    {0},
};

CHECK_DEFINE(
    gradients, ia_assumption, 250, .cost = 0.2,
    .property = "ia of a linear field = slope + f_i C sum V x W: exact where sum V x W = 0",
    .measure = measure_assumption, .mutants = assumption_mutants);
