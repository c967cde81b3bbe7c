/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shared by the checks of gradient operators: a right or wrong operator as subject, fields with
 * known gradients, errors over a cloud, interior and edge separately. */
#pragma once

#include "clouds.h"
#include "naive.h"

struct gradient_subject {
    const struct operator_form *form;
    enum naive_fault fault; /* NAIVE_NONE: src's operator; else the naive one with this fault */
};

/* Fields of high entropy: mixed polynomials of full degree 0..3 and smooth ones. */
enum gradient_function {
    FUNCTION_CONSTANT,
    FUNCTION_LINEAR,
    FUNCTION_QUADRATIC,
    FUNCTION_CUBIC,
    FUNCTION_SMOOTH
};
double gradient_study_field(enum gradient_function field, int dim, const double *x,
                            double *gradient);
const char *gradient_study_field_name(enum gradient_function field);

struct gradient_errors {
    double interior, edge; /* largest |gradient - exact| h / max|f|; NaN where a gradient is */
    double interior_rms;
    double condition; /* largest */
    size_t inside, outside;
};

/* Writes the gradient of f (n) to gradient[0..dim-1] (n each); point as in operator_apply or NULL
 * (a wrong subject fills it like the right operator). */
enum status gradient_study_apply(const struct gradient_subject *subject,
                                 const struct kernel *kernel, const struct cloud *cloud,
                                 const double *f, double *const *gradient,
                                 struct operator_point *point, struct error *error);

/* The errors of a subject for one field. */
enum status gradient_study_errors(const struct gradient_subject *subject,
                                  const struct kernel *kernel,
                                  const struct clouds_settings *settings,
                                  const struct clouds_cloud *cloud, enum gradient_function field,
                                  struct gradient_errors *errors, struct error *error);

/* Points along an axis in the quick checks, and the settings of a quick cloud. */
struct clouds_settings gradient_study_cloud(enum clouds_kind kind, int dim);
