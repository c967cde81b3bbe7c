/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cubic spline with everything supplied, and with one fault that the compiler option
 * -DFAULT=NAME chooses: what sphproof says to each is worth a look. NONE is a right kernel. */
#include <math.h>
#include <stdlib.h>

#include "plugin.h"

/* Subtle faults pass a careless test; gross ones make the kernel unusable. */
enum {
    NONE,
    CONSTANT_SEVENTH_DIGIT,
    CONSTANT_WRONG_IN_2D,
    DH_POWER,
    DH_OUTER_BRANCH,
    DW_ELEVENTH_DIGIT,
    JUMP_AT_KNOT,
    JUMP_IN_CURVATURE,
    EXTRA_KNOT,
    CLASS_OVERSTATED,
    SUPPORT_SHORT,
    BEYOND_EDGE,
    WRONG_IN_3D,
    GROSS,
    NOT_A_NUMBER = GROSS,
    CONSTANT_NEGATIVE,
    KNOTS_TOO_MANY,
    KNOTS_NEGATIVE,
    KNOTS_DESCENDING,
    KNOTS_EQUAL,
    KNOT_NEGATIVE,
    KNOT_BEYOND,
    KNOT_UNSET,
    CLASS_NEGATIVE,
    ZERO,
    CONSTANT_INFINITE,
    CRASH,
    EXIT
};

static const double pi = 3.14159265358979323846;

double sphproof_kernel_w(double q, int dim)
{
    if (FAULT == NOT_A_NUMBER && q > 0.3) return sqrt(-q);
    if (FAULT == ZERO) return 0;
    if (FAULT == EXIT) exit(0);
    if (FAULT == CRASH && q > 0.3) abort();
    if (FAULT == SUPPORT_SHORT) q /= 0.999;
    if (q >= 1) return FAULT == BEYOND_EDGE && q < 1.2 ? 1e-12 : 0;
    const double a = 1 - q;
    if (q >= 0.5) return 2 * a * a * a + (FAULT == JUMP_AT_KNOT ? 1e-9 : 0);
    double w = 1 - 6 * q * q * a;
    if (FAULT == JUMP_IN_CURVATURE) w += 3e-6 * (0.5 - q) * (0.5 - q);
    if (FAULT == EXTRA_KNOT && q < 0.2) w += 1e-4 * (0.2 - q) * (0.2 - q) * (0.2 - q);
    if (FAULT == WRONG_IN_3D && dim == 3) w += 1e-8 * q * q;
    return w;
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    const double scale = FAULT == SUPPORT_SHORT ? 1 / 0.999 : 1;
    q *= scale;
    if (q >= 1) return 0;
    const double a = 1 - q;
    if (q >= 0.5) return -6 * a * a * scale * (FAULT == DW_ELEVENTH_DIGIT ? 1 + 3e-11 : 1);
    double dw = q * (18 * q - 12);
    if (FAULT == JUMP_IN_CURVATURE) dw -= 6e-6 * (0.5 - q);
    if (FAULT == EXTRA_KNOT && q < 0.2) dw -= 3e-4 * (0.2 - q) * (0.2 - q);
    return dw * scale;
}

double sphproof_kernel_constant(int dim)
{
    const double constant = dim == 1 ? 4. / 3 : dim == 2 ? 40 / (7 * pi) : 8 / pi;
    if (FAULT == CONSTANT_SEVENTH_DIGIT) return constant * (1 + 3e-7);
    if (FAULT == CONSTANT_WRONG_IN_2D && dim == 2) return 20 / (7 * pi);
    if (FAULT == CONSTANT_NEGATIVE) return -constant;
    if (FAULT == CONSTANT_INFINITE) return HUGE_VAL;
    return constant * (FAULT == SUPPORT_SHORT ? pow(0.999, -dim) : 1);
}

double sphproof_kernel_dw_dh(double r, double h, int dim)
{
    const double q = r / h, a = 1 - q;
    const double c = sphproof_kernel_constant(dim) * pow(h, FAULT == DH_POWER ? -dim : -dim - 1);
    if (FAULT == DH_OUTER_BRANCH && q >= 0.5 && q < 1)
        return -2 * c * a * a * (dim + (dim + 3) * q);
    return -c * (dim * sphproof_kernel_w(q, dim) + q * sphproof_kernel_dw(q, dim));
}

int sphproof_kernel_knots(int dim, double *knots)
{
    (void)dim;
    knots[0] = FAULT == SUPPORT_SHORT ? 0.5 * 0.999 : 0.5;
    knots[1] = FAULT == KNOTS_EQUAL ? 0.5 : FAULT == KNOT_BEYOND ? 1.25 : 0.25;
    if (FAULT == KNOT_NEGATIVE) knots[0] = -0.001;
    if (FAULT == NONE) knots[0] = 0, knots[1] = 0.5, knots[2] = 1; /* the ends may be named */
    if (FAULT == KNOTS_TOO_MANY) return SPHPROOF_KERNEL_KNOTS_MAX + 1;
    if (FAULT == KNOTS_NEGATIVE) return -1;
    if (FAULT == KNOTS_DESCENDING || FAULT == KNOTS_EQUAL || FAULT == KNOT_BEYOND) return 2;
    return FAULT == KNOT_UNSET || FAULT == NONE ? 3 : 1;
}

int sphproof_kernel_class(int dim)
{
    (void)dim;
    if (FAULT == CLASS_NEGATIVE) return -1;
    return FAULT == CLASS_OVERSTATED ? 3 : 2;
}
