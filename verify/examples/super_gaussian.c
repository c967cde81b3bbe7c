/* SPDX-License-Identifier: GPL-3.0-or-later
 * Monaghan & Gingold's super-Gaussian (1983, eq. 3.15), ((d+2)/2 - x^2) exp(-x^2) with x = 4 q:
 * its second moment vanishes, at the price of a negative lobe, which is declared. At the edge,
 * where it is 2e-6, it is shifted to zero. */
#include <math.h>

#include "plugin.h"

double sphproof_kernel_w(double q, int dim)
{
    if (q >= 1) return 0;
    const double edge = (0.5 * dim + 1 - 16) * exp(-16.);
    return (0.5 * dim + 1 - 16 * q * q) * exp(-16 * q * q) - edge;
}

double sphproof_kernel_dw(double q, int dim)
{
    if (q >= 1) return 0;
    return -32 * q * (0.5 * dim + 2 - 16 * q * q) * exp(-16 * q * q);
}

int sphproof_kernel_class(int dim)
{
    (void)dim;
    return 0;
}

int sphproof_kernel_negative(int dim)
{
    (void)dim;
    return 1;
}
