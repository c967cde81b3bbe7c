/* SPDX-License-Identifier: GPL-3.0-or-later
 * A Gaussian of standard deviation h/3, cut off at the support's edge. Shifted to zero there it is
 * a right kernel of class C0; compiled with -DUNSHIFTED, W jumps from 1.1e-2 to 0 at r = h, and
 * sphproof rejects it for that reason. */
#include <math.h>

#include "plugin.h"

#ifdef UNSHIFTED
static const double shift = 0;
#else
static const double shift = 0.011108996538242306496; /* exp(-4.5) */
#endif

double sphproof_kernel_w(double q, int dim)
{
    (void)dim;
    return q < 1 ? exp(-4.5 * q * q) - shift : 0;
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    return q < 1 ? -9 * q * exp(-4.5 * q * q) : 0;
}

int sphproof_kernel_class(int dim)
{
    (void)dim;
    return 0;
}
