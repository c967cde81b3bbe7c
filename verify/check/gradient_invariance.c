/* SPDX-License-Identifier: GPL-3.0-or-later
 * Invariance of gradient operators: of all under translation and rotation of the cloud; and the two
 * corrections of normalised_corrected one by one: homogeneity of space (Bonet & Lok 1999: sum V Wn
 * = 1, sum V grad Wn = 0) by the normalised kernel, isotropy (sum V B g (x) x = 1) by the matrix.
 */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "gradient_forms.h"
#include "worst.h"

/* A rotation that maps no lattice axis to another; -1 in 1D. */
static void rotation_make(int dim, double *R)
{
    const double c = cos(0.7), s = sin(0.7), e = cos(1.9), t = sin(1.9);
    const double one[] = {-1}, two[] = {c, -s, s, c};
    const double three[] = {c, -s * e, s * t, s, c * e, -c * t, 0, t, e};
    const double *from = dim == 1 ? one : dim == 2 ? two : three;
    for (int i = 0; i < dim * dim; i++) R[i] = from[i];
}

/* Largest |grad in the moved cloud - R grad| h / max|f| / condition. */
static double moved_difference(const struct gradient_subject *subject, const struct kernel *kernel,
                               int dim, const double *R, const double *shift)
{
    const struct clouds_settings settings = gradient_study_cloud(CLOUDS_CLUSTERED, dim);
    struct clouds_cloud cloud;
    double worst = (double)NAN;
    if (clouds_make(&settings, &cloud, NULL)) return worst;
    const size_t n = cloud.cloud.points.n;
    double *m = calloc(7 * n, sizeof *m), largest = 0;
    struct operator_point *point = calloc(n, sizeof *point);
    double *const before[3] = {m + n, m + 2 * n, m + 3 * n};
    double *const after[3] = {m + 4 * n, m + 5 * n, m + 6 * n};
    bool ok = m && point;
    for (size_t i = 0; ok && i < n; i++) {
        double x[3] = {0}, unused[3];
        for (int a = 0; a < dim; a++) x[a] = cloud.x[a][i];
        m[i] = gradient_study_field(FUNCTION_SMOOTH, dim, x, unused);
        largest = fmax(largest, fabs(m[i]));
    }
    ok = ok && !gradient_study_apply(subject, kernel, &cloud.cloud, m, before, point, NULL);
    clouds_transform(&cloud, R, shift);
    ok = ok && !gradient_study_apply(subject, kernel, &cloud.cloud, m, after, point, NULL);
    if (ok) worst = 0;
    for (size_t i = 0; ok && i < n; i++)
        for (int a = 0; a < dim; a++) {
            double turned = 0;
            for (int b = 0; b < dim; b++) turned += R[a * dim + b] * before[b][i];
            const double scale = subject->form->corrected ? point[i].condition : 1;
            const double error = fabs(after[a][i] - turned) * cloud.h[i] / largest / scale;
            worst_keep(&worst, error);
        }
    free(m), free(point);
    clouds_free(&cloud);
    return worst;
}

static void measure_invariance(struct check_run *run, const void *subject)
{
    static const double shift[] = {3.7, -5.1, 2.3}, nowhere[3] = {0};
    const struct gradient_subject *s = subject;
    struct kernel kernel = {0};
    kernel_select(&kernel, "wendland_c4", 5, NULL);
    for (int dim = 1; dim <= 3; dim++) {
        double R[9], unit[9] = {0};
        rotation_make(dim, R);
        for (int a = 0; a < dim; a++) unit[a * dim + a] = 1;
        /* positions lose |shift|/h units in the last place */
        check_measure(run, moved_difference(s, &kernel, dim, unit, shift), 1e-11, 1e-13,
                      "%s, %dD, translated", s->form->member.name, dim);
        check_measure(run, moved_difference(s, &kernel, dim, R, nowhere), 1e-12, 1e-14,
                      "%s, %dD, %s", s->form->member.name, dim, dim == 1 ? "mirrored" : "rotated");
    }
}

static const struct check_mutant invariance_mutants[] = {
    {"invariance_diagonal", "off-diagonal matrix elements dropped",
     SUBJECT(linear_exact, DIAGONAL)},
    {"invariance_absolute", "r_j for r_j - r_i in the matrix", SUBJECT(ia, ABSOLUTE)},
    {"invariance_float", "pairs in single precision", SUBJECT(standard, FLOAT)},
    {0},
};

CHECK_DEFINE(gradients, invariance, 250,
             .property = "|grad(Rx + t) - R grad(x)| h/max|f| (per condition number)",
             .subjects = gradient_subjects, .measure = measure_invariance,
             .mutants = invariance_mutants);

/* ---- homogeneity and isotropy ---- */

struct defects {
    double homogeneity; /* largest |sum V p| h: the gradient of 1 */
    double isotropy;    /* largest |sum V p (x) x - 1|, interior and edge */
    double condition;
};

static bool defects_of(const struct gradient_subject *subject, const struct kernel *kernel,
                       enum clouds_kind kind, int dim, struct defects *defects)
{
    const struct clouds_settings settings = gradient_study_cloud(kind, dim);
    struct clouds_cloud cloud;
    if (clouds_make(&settings, &cloud, NULL)) return false;
    const size_t n = cloud.cloud.points.n;
    double *m = calloc(7 * n, sizeof *m);
    struct operator_point *point = calloc(n, sizeof *point);
    double *const one[3] = {m + n, m + 2 * n, m + 3 * n};
    double *const linear[3] = {m + 4 * n, m + 5 * n, m + 6 * n};
    bool ok = m && point;
    *defects = (struct defects){0};
    for (size_t i = 0; ok && i < n; i++) m[i] = 1;
    ok = ok && !gradient_study_apply(subject, kernel, &cloud.cloud, m, one, point, NULL);
    for (int b = 0; ok && b < dim; b++) {
        ok = !gradient_study_apply(subject, kernel, &cloud.cloud, cloud.x[b], linear, point, NULL);
        for (size_t i = 0; ok && i < n; i++)
            for (int a = 0; a < dim; a++) { /* sum V p (x_j - x_i) by linearity */
                const double D = linear[a][i] - cloud.x[b][i] * one[a][i];
                const double isotropy = fabs(D - (a == b)), homogeneity = fabs(one[a][i]);
                worst_keep(&defects->isotropy, isotropy);
                worst_keep(&defects->homogeneity, homogeneity * cloud.h[i]);
                defects->condition = fmax(defects->condition, point[i].condition);
            }
    }
    free(m), free(point);
    clouds_free(&cloud);
    return ok;
}

/* The plain kernel has both defects, each correction alone removes one (the matrix: isotropy), both
 * together remove both. */
static void measure_corrections(struct check_run *run, const void *subject)
{
    static const struct gradient_subject plain = {&standard, NAIVE_NONE},
                                         shepard = {&normalised_without_matrix, NAIVE_NONE},
                                         matrix = {&corrected_without_normalisation, NAIVE_NONE},
                                         both = {&normalised_plain, NAIVE_NONE};
    const struct gradient_subject *s = subject ? subject : &both;
    const double least = 1e-2;
    struct kernel kernel = {0};
    kernel_select(&kernel, "wendland_c2", 5, NULL);
    for (int dim = 1; dim <= 3; dim++)
        for (int kind = CLOUDS_JITTERED; kind < CLOUDS_KINDS; kind++) {
            struct defects without, normal, correct, full;
            const enum clouds_kind k = (enum clouds_kind)kind;
            const char *name = clouds_name(k);
            if (!defects_of(&plain, &kernel, k, dim, &without) ||
                !defects_of(&shepard, &kernel, k, dim, &normal) ||
                !defects_of(&matrix, &kernel, k, dim, &correct) ||
                !defects_of(s, &kernel, k, dim, &full)) {
                check_measure(run, (double)NAN, 0, 0, "no memory");
                continue;
            }
            check_measure(run, full.homogeneity, 1e-12 * full.condition, 1e-14 * full.condition,
                          "%dD, %s: homogeneity; plain %.1e, matrix only %.1e", dim, name,
                          without.homogeneity, correct.homogeneity);
            check_measure(run, full.isotropy, 1e-12 * full.condition, 1e-14 * full.condition,
                          "%dD, %s: isotropy; plain %.1e, normalised only %.1e", dim, name,
                          without.isotropy, normal.isotropy);
            check_measure(run, normal.homogeneity, 1e-12, 1e-14,
                          "%dD, %s: homogeneity of the normalised kernel alone", dim, name);
            check_measure(run, correct.isotropy, 1e-12 * correct.condition,
                          1e-14 * correct.condition, "%dD, %s: isotropy by the matrix alone", dim,
                          name);
            check_measure(run, least / fmin(without.homogeneity, correct.homogeneity), 1, 1e-4,
                          "%dD, %s: the matrix alone is not homogeneous", dim, name);
            check_measure(run, least / fmin(without.isotropy, normal.isotropy), 1, 1e-4,
                          "%dD, %s: the normalised kernel alone is not isotropic", dim, name);
        }
}

static const struct check_mutant corrections_mutants[] = {
    {"corrections_shepard_only", "normalised kernel without gradient correction",
     SUBJECT(normalised_without_matrix, NONE)},
    {"corrections_matrix_only", "gradient correction without the normalised kernel",
     SUBJECT(corrected_without_normalisation, NONE)},
    {"corrections_transposed", "B transposed", SUBJECT(normalised_plain, TRANSPOSED)},
    {"corrections_constant_sum", "derivative of S left out",
     SUBJECT(normalised_plain, NO_NORMALISATION_GRADIENT)},
    {"corrections_no_self", "S without j = i", SUBJECT(normalised_plain, SELF_WITHOUT)},
    {0},
};

CHECK_DEFINE(gradients, corrections, 250, .cost = 0.6,
             .property =
                 "normalised_corrected: |sum V p| h = 0 (homogeneity), |sum V p (x) x - 1| = 0 "
                 "(isotropy), before and after each correction",
             .measure = measure_corrections, .mutants = corrections_mutants);
