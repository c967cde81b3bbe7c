/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel.h"

#include <math.h>
#include <string.h>

/* One pass over the list defines the descriptors, a second one lists them. */
#define KERNEL(name, ...)                                                                          \
    static const struct kernel kernel_##name = {.w = name##_w, .dw = name##_dw, __VA_ARGS__};
#include "kernels.def"
#undef KERNEL

static const struct member *const members[] = {
#define KERNEL(name, ...) &kernel_##name.member,
#include "kernels.def"
#undef KERNEL
};

const struct family kernel_family = {"kernels", "kernels W(r,h), h = support radius", members,
                                     sizeof members / sizeof *members};

enum status kernel_select(struct kernel *kernel, const char *name, int sinc_order,
                          struct error *error)
{
    (void)sinc_order;
    const struct member *member = family_find(&kernel_family, name);
    if (!member) return error_set(error, STATUS_BAD_INPUT, "no kernel '%s'", name);
    *kernel = *(const struct kernel *)member;
    return STATUS_OK;
}

static double power(double x, int n)
{
    double y = 1;
    for (int i = 0; i < n; i++) y *= x;
    return y;
}

double kernel_value(const struct kernel *kernel, double r, double h, int dim)
{
    return kernel->constant[dim] / power(h, dim) * kernel->w(kernel, r / h, dim);
}

double kernel_dr(const struct kernel *kernel, double r, double h, int dim)
{
    return kernel->constant[dim] / power(h, dim + 1) * kernel->dw(kernel, r / h, dim);
}

double kernel_dh(const struct kernel *kernel, double r, double h, int dim)
{
    if (kernel->plugin_dw_dh) return kernel->plugin_dw_dh(r, h, dim);
    const double q = r / h;
    return -kernel->constant[dim] / power(h, dim + 1) *
           (dim * kernel->w(kernel, q, dim) + q * kernel->dw(kernel, q, dim));
}

double kernel_least_eta(const struct kernel *kernel, int dim)
{
    return pow(kernel->constant[dim] * kernel->w(kernel, 0, dim), 1. / dim);
}
