/* SPDX-License-Identifier: GPL-3.0-or-later
 * A right kernel in its shortest form: Wendland C8, w = (1-q)^10 (1 + 10 q + 42 q^2 + 90 q^3 +
 * 429/5 q^4). Constants, knots and dW/dh are left to sphproof. */
#include "plugin.h"

const char *sphproof_kernel_name(void)
{
    return "wendland_c8";
}

double sphproof_kernel_w(double q, int dim)
{
    (void)dim;
    if (q >= 1) return 0;
    const double a = 1 - q, a2 = a * a, a5 = a2 * a2 * a;
    return a5 * a5 * (1 + q * (10 + q * (42 + q * (90 + q * (429. / 5)))));
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    if (q >= 1) return 0;
    const double a = 1 - q, a3 = a * a * a;
    return -26 * q * (a3 * a3 * a3) * (1 + q * (9 + q * (159. / 5 + q * (231. / 5))));
}

int sphproof_kernel_class(int dim)
{
    (void)dim;
    return 8;
}
