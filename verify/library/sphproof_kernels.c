/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphproof/kernels.h"

#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdlib.h>

#include "library.h"
#include "measure.h"
#include "property.h"

enum { SAMPLES = 1 << 18, PROBES = 257, ORDER = 5 };

enum sphproof_status sphproof_kernels_find(const char *name, struct sphproof_kernel **kernel,
                                           struct sphproof_error *error)
{
    struct error ours;
    *kernel = calloc(1, sizeof **kernel);
    if (!*kernel) return library_fail(error, STATUS_ENVIRONMENT, "no memory for a kernel");
    const enum status status = kernel_select(&(*kernel)->kernel, name ? name : "", ORDER, &ours);
    (*kernel)->negative = (*kernel)->kernel.order != 0;
    if (!status) return SPHPROOF_OK;
    sphproof_kernels_free(*kernel);
    *kernel = NULL;
    return library_pass(status, &ours, error);
}

void sphproof_kernels_free(struct sphproof_kernel *kernel)
{
    free(kernel);
}

static double shape_w(const struct kernel *kernel, double q, int dim)
{
    return kernel->plugin_w(q, dim);
}

static double shape_dw(const struct kernel *kernel, double q, int dim)
{
    return kernel->plugin_dw(q, dim);
}

static struct terms terms_of(const struct sphproof_kernel *kernel, long samples)
{
    struct terms terms = pieces_terms_usual;
    terms.samples = samples;
    terms.single = kernel->single;
    terms.negative = kernel->negative;
    terms.class_found = kernel->found_class;
    return terms;
}

static enum sphproof_status check_shape(const struct kernel *kernel, int dim,
                                        struct sphproof_error *error)
{
    double largest = 0;
    for (int i = 0; i <= PROBES; i++) {
        const double q = (double)i / PROBES;
        const double w = kernel->w(kernel, q, dim), dw = kernel->dw(kernel, q, dim);
        if (!isfinite(w) || !isfinite(dw))
            return library_fail(error, STATUS_BAD_INPUT,
                                "kernel %.80s: dim %d, q = %.6g: w = %g, dw = %g; allowed: finite "
                                "values",
                                kernel->member.name, dim, q, w, dw);
        largest = fmax(largest, fabs(w));
    }
    if (largest > 0) return SPHPROOF_OK;
    return library_fail(error, STATUS_BAD_INPUT, "kernel %.80s: dim %d: w is 0 everywhere",
                        kernel->member.name, dim);
}

/* Finds the constant and the class if they are not declared. */
static enum sphproof_status complete(struct sphproof_kernel *own, int dim, int smoothness,
                                     struct sphproof_error *error)
{
    struct kernel *kernel = &own->kernel;
    const struct terms terms = terms_of(own, pieces_terms_usual.samples);
    struct pieces pieces;
    struct error ours;
    if (check_shape(kernel, dim, error)) return SPHPROOF_BAD_INPUT;
    const enum status status = pieces_find(&pieces, kernel, dim, &terms, &ours);
    if (status) return library_pass(status, &ours, error);
    if (!(kernel->constant[dim] != 0)) kernel->constant[dim] = measure_constant(&pieces);
    kernel->smoothness[dim] = smoothness;
    if (own->found_class) {
        struct measure_class class;
        measure_class(&pieces, &class);
        kernel->smoothness[dim] = class.class > 0 ? class.class : 0;
    }
    pieces_free(&pieces);
    if (isfinite(kernel->constant[dim]) && kernel->constant[dim] > 0) return SPHPROOF_OK;
    return library_fail(error, STATUS_BAD_INPUT,
                        "kernel %.80s: dim %d: the constant is %g; allowed: above 0",
                        kernel->member.name, dim, kernel->constant[dim]);
}

static enum sphproof_status check_knots(const struct sphproof_shape *shape,
                                        struct sphproof_error *error)
{
    for (int i = 0; i < shape->knot_count; i++)
        if (!(shape->knots[i] > (i ? shape->knots[i - 1] : 0) && shape->knots[i] < 1))
            return library_fail(error, STATUS_BAD_INPUT,
                                "knot %d of %d is %.17g; allowed: ascending in ]0, 1[", i + 1,
                                shape->knot_count, shape->knots[i]);
    return SPHPROOF_OK;
}

enum sphproof_status sphproof_kernels_own(const struct sphproof_shape *shape,
                                          struct sphproof_kernel **kernel,
                                          struct sphproof_error *error)
{
    *kernel = NULL;
    if (!shape->w || !shape->dw || (shape->knot_count > 0 && !shape->knots) || shape->dim < 0 ||
        shape->dim > KERNEL_DIM_MAX)
        return library_fail(error, STATUS_BAD_INPUT,
                            "a kernel needs w, dw, its knots (%d) and a dim from 0 to 3 (%d)",
                            shape->knot_count, shape->dim);
    enum sphproof_status status = check_knots(shape, error);
    if (status) return status;
    struct sphproof_kernel *own = calloc(1, sizeof *own);
    if (!own) return library_fail(error, STATUS_ENVIRONMENT, "no memory for a kernel");
    *own =
        (struct sphproof_kernel){.kernel = {.member = {shape->name ? shape->name : "yours", "", ""},
                                            .w = shape_w,
                                            .dw = shape_dw,
                                            .plugin_w = shape->w,
                                            .plugin_dw = shape->dw,
                                            .knot_count = shape->knot_count,
                                            .knots = shape->knots},
                                 .dim = shape->dim,
                                 .negative = shape->negative,
                                 .single = shape->single,
                                 .found_class = shape->smoothness < 0};
    for (int dim = 1; dim <= KERNEL_DIM_MAX && !status; dim++) {
        own->kernel.constant[dim] = shape->constant[dim];
        if (!own->dim || own->dim == dim) status = complete(own, dim, shape->smoothness, error);
    }
    if (status)
        free(own);
    else
        *kernel = own;
    return status;
}

double sphproof_kernels_value(const struct sphproof_kernel *kernel, double r, double h, int dim)
{
    return kernel_value(&kernel->kernel, r, h, dim);
}

double sphproof_kernels_dr(const struct sphproof_kernel *kernel, double r, double h, int dim)
{
    return kernel_dr(&kernel->kernel, r, h, dim);
}

double sphproof_kernels_dh(const struct sphproof_kernel *kernel, double r, double h, int dim)
{
    return kernel_dh(&kernel->kernel, r, h, dim);
}

/* ---- the certificate ---- */

struct certify_sink {
    struct property_sink sink;
    const struct property *property;
    struct library_figures *figures;
    bool single;
};

static void take(struct property_sink *sink, const struct finding *given)
{
    const struct certify_sink *context = (const struct certify_sink *)sink;
    const struct finding found = context->single ? property_single(given) : *given;
    const struct sphproof_figure figure = {.property = context->property->name,
                                           .formula = context->property->formula,
                                           .where = found.subject,
                                           .value = found.value,
                                           .bound = found.bound,
                                           .floor = found.floor,
                                           .skipped = found.status == FINDING_SKIP,
                                           .passed = found.status != FINDING_FAIL};
    library_figure(context->figures, &figure);
}

enum sphproof_status sphproof_kernels_certify(const struct sphproof_kernel *kernel, int dim,
                                              sphproof_figure_sink *sink, void *context,
                                              struct sphproof_error *error)
{
    struct library_figures figures = {.sink = sink, .context = context, .error = error};
    struct certify_sink certify = {{take}, NULL, &figures, kernel->single};
    const struct terms terms = terms_of(kernel, SAMPLES);
    struct pieces pieces;
    struct error ours;
    if (dim < 1 || dim > KERNEL_DIM_MAX || (kernel->dim && kernel->dim != dim))
        return library_fail(error, STATUS_BAD_INPUT, "kernel %.80s: dim = %d is not among its own",
                            kernel->kernel.member.name, dim);
    const enum status status = pieces_find(&pieces, &kernel->kernel, dim, &terms, &ours);
    if (status) return library_pass(status, &ours, error);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    for (size_t i = 0; i < property_count; i++) {
        certify.property = &property_list[i];
        property_list[i].measure(&pieces, &certify.sink);
    }
    gsl_set_error_handler(handler);
    pieces_free(&pieces);
    return figures.failed ? SPHPROOF_CHECK_FAILED : SPHPROOF_OK;
}
