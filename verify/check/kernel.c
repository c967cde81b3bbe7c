/* SPDX-License-Identifier: GPL-3.0-or-later
 * Group `kernels`: every property of properties.def on every kernel in 1, 2 and 3 dimensions. */
#include "kernel.h"

#include <math.h>
#include <stdio.h>

#include "check.h"
#include "kernel_mutants.h"
#include "property.h"

/* The sinc family at its default and its ends. */
static const int sinc_orders[] = {5, 3, 12};
enum { SINC_ORDERS = sizeof sinc_orders / sizeof *sinc_orders };

/* Subjects: the family's members, sinc again at its other orders, the user's kernel. */
static size_t subject_count(void)
{
    return kernel_family.n + SINC_ORDERS - 1 + (check_kernel_plugin != NULL);
}

static const void *subject(size_t i)
{
    static struct kernel kernel; /* until the next one is asked for */
    const size_t extra = i < kernel_family.n ? 0 : i - kernel_family.n + 1;
    if (extra == SINC_ORDERS) return check_kernel_plugin;
    const char *name = extra ? "sinc" : kernel_family.members[i]->name;
    kernel_select(&kernel, name, sinc_orders[extra], NULL);
    return &kernel;
}

/* Passes the figures of a property on to the check. */
struct check_sink {
    struct property_sink sink;
    struct check_run *run;
    const struct pieces *pieces;
};

static void take(struct property_sink *sink, double value, double bound, double floor,
                 const char *where, bool skipped)
{
    const struct check_sink *context = (const struct check_sink *)sink;
    const struct kernel *kernel = context->pieces->kernel;
    char name[64];
    if (kernel->order)
        snprintf(name, sizeof name, "%.40s %d", kernel->member.name, kernel->order);
    else
        snprintf(name, sizeof name, "%.60s", kernel->member.name);
    if (skipped)
        check_skip(context->run, "%s, dim %d: %s", name, context->pieces->dim, where);
    else
        check_measure(context->run, value, bound, floor, "%s, dim %d, %s", name,
                      context->pieces->dim, where);
}

static void measure(struct check_run *run, const struct kernel *kernel,
                    void (*property)(const struct pieces *, struct property_sink *))
{
    for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++) {
        struct pieces pieces;
        if (pieces_find(&pieces, kernel, dim, NULL)) {
            check_measure(run, (double)NAN, 0, 0, "%s, dim %d: no memory", kernel->member.name,
                          dim);
            continue;
        }
        struct check_sink context = {{take}, run, &pieces};
        property(&pieces, &context.sink);
        pieces_free(&pieces);
    }
}

#define PROPERTY(name_, formula)                                                                   \
    static void measure_##name_(struct check_run *run, const void *kernel)                         \
    {                                                                                              \
        measure(run, kernel, property_##name_);                                                    \
    }                                                                                              \
    const struct check check_kernel_##name_ = {.group = "kernels",                                 \
                                               .name = #name_,                                     \
                                               .property = formula,                                \
                                               .subject_count = subject_count,                     \
                                               .subject = subject,                                 \
                                               .measure = measure_##name_,                         \
                                               .mutants = kernel_mutants_##name_};
#include "properties.def"
#undef PROPERTY
