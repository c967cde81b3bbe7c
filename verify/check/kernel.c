/* SPDX-License-Identifier: GPL-3.0-or-later
 * Group `kernels`: every property of properties.def on every kernel in 1, 2 and 3 dimensions. */
#include "kernel.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "check.h"
#include "kernel_mutants.h"
#include "property.h"
#include "user_figures.h"

/* Orders of the sinc family: default, least and greatest. */
static const int sinc_orders[] = {5, 3, 12};
enum { SINC_ORDERS = sizeof sinc_orders / sizeof *sinc_orders };

static void add(struct check_run *run, const char *name, int sinc_order)
{
    struct kernel kernel;
    kernel_select(&kernel, name, sinc_order, NULL);
    check_subject(run, &kernel, sizeof kernel);
}

/* The family's members, sinc at its other orders, the user's kernel. */
static void subjects(struct check_run *run)
{
    for (size_t k = 0; k < kernel_family.n; k++)
        add(run, kernel_family.members[k]->name, sinc_orders[0]);
    for (size_t i = 1; i < SINC_ORDERS; i++) add(run, "sinc", sinc_orders[i]);
    if (check_kernel_plugin) check_subject(run, check_kernel_plugin, 0);
}

/* Passes the figures of a property on to the check. */
struct check_sink {
    struct property_sink sink;
    struct check_run *run;
    const struct pieces *pieces;
    bool failed;
};

static void take(struct property_sink *sink, const struct finding *figure)
{
    struct check_sink *context = (struct check_sink *)sink;
    const struct kernel *kernel = context->pieces->kernel;
    char name[64];
    if (kernel->order)
        snprintf(name, sizeof name, "%.40s %d", kernel->member.name, kernel->order);
    else
        snprintf(name, sizeof name, "%.60s", kernel->member.name);
    if (figure->status == FINDING_SKIP)
        check_skip(context->run, "%s, dim %d: %s", name, context->pieces->dim, figure->subject);
    else
        check_measure(context->run, figure->value, figure->bound, figure->floor, "%s, dim %d, %s",
                      name, context->pieces->dim, figure->subject);
    context->failed = context->failed || figure->status == FINDING_FAIL;
}

/* Adds curves for the plot of a failure: w, dw and the correct dw. */
static void show_shape(struct check_run *run, const struct kernel *kernel, int dim)
{
    enum { POINTS = 421 };
    const double reach = 1.05, step = 1e-6;
    double q[POINTS], w[POINTS], dw[POINTS], slope[POINTS];
    char label[128];
    for (int i = 0; i < POINTS; i++) {
        q[i] = fmax(reach * i / (POINTS - 1), step);
        w[i] = kernel->w(kernel, q[i], dim);
        dw[i] = kernel->dw(kernel, q[i], dim);
        slope[i] = (kernel->w(kernel, q[i] + step, dim) - kernel->w(kernel, q[i] - step, dim)) /
                   (2 * step);
    }
    snprintf(label, sizeof label, "w of %.60s, dim %d", kernel->member.name, dim);
    check_series(run, label, POINTS, q, w);
    check_series(run, "dw", POINTS, q, dw);
    check_series(run, "slope of w", POINTS, q, slope);
}

/* Passes on figures of the user's kernel, which another process has measured. */
static void pass_on(struct check_run *run, const struct user_figures *user, const char *property)
{
    size_t n = 0;
    for (size_t i = 0; i < user->figures.count; i++) {
        const struct finding *figure = &user->figures.list[i];
        if (strcmp(figure->what, property) != 0) continue;
        if (figure->status == FINDING_SKIP)
            check_skip(run, "%s", figure->subject);
        else
            check_measure(run, figure->value, figure->bound, figure->floor, "%s", figure->subject);
        n++;
    }
    if (n == 0) check_skip(run, "%s: not measured, it does not run", user->name);
}

static void measure(struct check_run *run, const void *subject_, const char *name,
                    void (*property)(const struct pieces *, struct property_sink *))
{
    const struct kernel *kernel = subject_;
    if (check_kernel_plugin && subject_ == check_kernel_plugin) {
        pass_on(run, check_kernel_plugin, name);
        return;
    }
    bool shown = false;
    for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++) {
        struct pieces pieces;
        if (pieces_find(&pieces, kernel, dim, NULL, NULL)) {
            check_measure(run, (double)NAN, 0, 0, "%s, dim %d: no memory", kernel->member.name,
                          dim);
            continue;
        }
        struct check_sink context = {{take}, run, &pieces, false};
        property(&pieces, &context.sink);
        if (context.failed && !shown) shown = true, show_shape(run, kernel, dim);
        pieces_free(&pieces);
    }
}

#define PROPERTY(name_, rank_, says_, formula_)                                                    \
    static void measure_##name_(struct check_run *run, const void *kernel)                         \
    {                                                                                              \
        measure(run, kernel, #name_, property_##name_);                                            \
    }                                                                                              \
    CHECK_DEFINE(kernels, name_, rank_, .says = says_, .property = formula_, .subjects = subjects, \
                 .measure = measure_##name_, .mutants = kernel_mutants_##name_);
#include "properties.def"
#undef PROPERTY
