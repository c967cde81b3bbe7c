/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Reading the list once defines the descriptors; reading it again lists them. */
#define KERNEL(name, ...)                                                                          \
    static const struct kernel kernel_##name = {.w = name##_w, .dw = name##_dw, __VA_ARGS__};
#include "kernel/kernels.def"
#undef KERNEL

enum {
    BUILT_IN = 0
#define KERNEL(name, ...) +1
#include "kernel/kernels.def"
#undef KERNEL
};

static const struct member *members[BUILT_IN + KERNEL_PLUGINS_MAX] = {
#define KERNEL(name, ...) &kernel_##name.member,
#include "kernel/kernels.def"
#undef KERNEL
};
static int plugins;

const struct family kernel_family = {"kernels", "kernels W(r,h), h = support radius", members,
                                     BUILT_IN};

int kernel_add(const struct kernel *plugin)
{
    if (plugins == KERNEL_PLUGINS_MAX) return -1;
    members[BUILT_IN + plugins] = &plugin->member;
    return BUILT_IN + plugins++;
}

int kernel_index(const char *name)
{
    for (int i = 0; i < BUILT_IN + plugins; i++)
        if (strcmp(members[i]->name, name) == 0) return i;
    return -1;
}

static double power(double x, int n)
{
    double y = 1;
    for (int i = 0; i < n; i++) y *= x;
    return y;
}

/* Integral over a < q < b of q^(dim-1) w(q): 16-point Gauss-Legendre on four panels. */
static double integral(const struct kernel *kernel, double a, double b, int dim)
{
    static const double node[8] = {0.095012509837637440185, 0.28160355077925891323,
                                   0.45801677765722738634,  0.61787624440264374845,
                                   0.7554044083550030339,   0.86563120238783174388,
                                   0.94457502307323257608,  0.9894009349916499326};
    static const double weight[8] = {0.18945061045506849629,  0.18260341504492358887,
                                     0.16915651939500253819,  0.14959598881657673208,
                                     0.12462897125553387205,  0.09515851168249278481,
                                     0.062253523938647892863, 0.027152459411754094852};
    enum { PANELS = 4 };
    const double half = (b - a) / (2 * PANELS);
    double sum = 0;
    for (int panel = 0; panel < PANELS; panel++)
        for (int i = 0; i < 16; i++) {
            const double x = i < 8 ? -node[i] : node[i - 8];
            const double q = a + half * (2 * panel + 1 + x);
            sum += weight[i % 8] * power(q, dim - 1) * kernel->w(kernel, q, dim);
        }
    return half * sum;
}

static void normalise(struct kernel *kernel, int dim)
{
    const double sphere[KERNEL_DIM_MAX + 1] = {0, 2, 2 * M_PI, 4 * M_PI};
    double sum = 0;
    for (int i = 0; i <= kernel->knot_count; i++)
        sum += integral(kernel, i ? kernel->knots[i - 1] : 0,
                        i < kernel->knot_count ? kernel->knots[i] : 1, dim);
    kernel->constant[dim] = 1 / (sphere[dim] * sum);
}

static enum status unknown(const char *name, struct error *error)
{
    char allowed[256] = "";
    for (size_t i = 0, n = 0; i < kernel_family.n && n < sizeof allowed; i++)
        n += (size_t)snprintf(allowed + n, sizeof allowed - n, "%s%s", i ? ", " : "",
                              kernel_family.members[i]->name);
    return error_set(error, STATUS_BAD_INPUT, "no kernel '%.64s'; there are %s", name, allowed);
}

enum status kernel_select(struct kernel *kernel, const char *name, int sinc_order,
                          struct error *error)
{
    const int index = kernel_index(name);
    if (index < 0) return unknown(name, error);
    *kernel = *(const struct kernel *)members[index];
    if (kernel->order) {
        if (sinc_order < SINC_ORDER_MIN || sinc_order > SINC_ORDER_MAX)
            return error_set(error, STATUS_BAD_INPUT, "sinc_n = %d: allowed are %d to %d",
                             sinc_order, SINC_ORDER_MIN, SINC_ORDER_MAX);
        kernel->order = sinc_order;
        /* below n = 5 the cut-off at q = 1 spoils the lattice sums at n/2 */
        kernel->default_eta = fmax(2.5, 0.5 * sinc_order);
        /* declared for n = 5 */
        if (sinc_order != 5) kernel->stable_eta[0] = kernel->stable_eta[1] = 0;
        for (int dim = 1; dim <= KERNEL_DIM_MAX; dim++) kernel->smoothness[dim] = sinc_order - 1;
    }
    for (int dim = 1; dim <= KERNEL_DIM_MAX && !kernel->plugin_w; dim++)
        if (kernel->constant[dim] == 0) normalise(kernel, dim);
    return STATUS_OK;
}

int kernel_specialisation(const struct kernel *kernel)
{
    for (size_t i = 0; i < kernel_family.n; i++) {
        const struct kernel *built_in = (const struct kernel *)kernel_family.members[i];
        if (built_in->w == kernel->w && built_in->dw == kernel->dw) return (int)i;
    }
    return -1;
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
