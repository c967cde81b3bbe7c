/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernels of the oracle: w(q) and dw/dq in long double, in the textbook's piecewise form, and their
 * constants. Nothing of src's kernels is used. */
#ifndef SPHPROOF_ORACLE_KERNEL_H
#define SPHPROOF_ORACLE_KERNEL_H

#include <stdbool.h>

struct oracle_kernel {
    long double constant; /* C_1: W = C_1/h w(r/h) in 1D */
    long double (*w)(int parameter, long double q);
    long double (*dw)(int parameter, long double q);
    int parameter; /* of a spline: its M_n; of sinc_n: n */
};

/* The kernel by its key, in 1D; false if the oracle does not know it. */
bool oracle_kernel_find(struct oracle_kernel *kernel, const char *name, int sinc_order);

#endif
