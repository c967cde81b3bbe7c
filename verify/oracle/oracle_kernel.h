/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernels of the oracle: w(q) and dw/dq in long double, in the textbook's piecewise form, and their
 * constants. Nothing of src's own kernels is used. */
#pragma once

#include "kernel.h"

struct oracle_kernel {
    long double constant; /* C_d: W = C_d/h^d w(r/h) */
    long double (*w)(int parameter, long double q);
    long double (*dw)(int parameter, long double q);
    int dim;
    int parameter;               /* n of a spline M_n or of sinc_n; power of a Wendland kernel */
    const struct kernel *source; /* a kernel that the oracle does not know; else NULL */
};

/* Finds the kernel in dim dimensions by its name. A kernel that the oracle does not know, such as a
 * new one, is used itself: then only the sums are judged, and the group kernels judges the
 * kernel. */
struct oracle_kernel oracle_kernel_find(const struct kernel *source, int dim);

/* w and dw/dq at q >= 0. */
long double oracle_kernel_w(const struct oracle_kernel *kernel, long double q);
long double oracle_kernel_dw(const struct oracle_kernel *kernel, long double q);

/* x^n, n >= 0. */
static inline long double oracle_power(long double x, int n)
{
    long double y = 1;
    while (n-- > 0) y *= x;
    return y;
}
