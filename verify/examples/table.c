/* SPDX-License-Identifier: GPL-3.0-or-later
 * A tabulated kernel: (1-q)^4 (1+4q) at 65 points (or at N, with -DPOINTS=N), and between them the
 * cubic spline with slope 0 at both ends. It is of class C2 and has a knot at every inner point;
 * sphproof finds both by itself. */
#include "plugin.h"

#ifndef POINTS
#define POINTS 65
#endif

static double value[POINTS], slope[POINTS];
static int filled;

/* Slopes of the spline: s[i-1] + 4 s[i] + s[i+1] = 3 (v[i+1] - v[i-1])/step, s = 0 at the ends. */
static void fill(void)
{
    const double step = 1. / (POINTS - 1);
    double upper[POINTS] = {0};
    for (int i = 0; i < POINTS; i++) {
        const double q = i * step, a = 1 - q;
        value[i] = a * a * a * a * (1 + 4 * q);
    }
    for (int i = 1; i < POINTS - 1; i++) {
        const double pivot = 4 - upper[i - 1];
        upper[i] = 1 / pivot;
        slope[i] = (3 * (value[i + 1] - value[i - 1]) / step - slope[i - 1]) / pivot;
    }
    for (int i = POINTS - 2; i > 0; i--) slope[i] -= upper[i] * slope[i + 1];
    filled = 1;
}

/* Value or derivative of the cubic in the interval of the point. */
static double evaluate(double q, int derivative)
{
    if (q >= 1) return 0;
    if (!filled) fill();
    const double step = 1. / (POINTS - 1), x = q / step;
    const int i = (int)x;
    const double t = x - i, rise = value[i + 1] - value[i];
    const double b = 3 * rise - step * (2 * slope[i] + slope[i + 1]);
    const double c = step * (slope[i] + slope[i + 1]) - 2 * rise;
    if (derivative) return slope[i] + t * (2 * b + 3 * c * t) / step;
    return value[i] + t * (step * slope[i] + t * (b + c * t));
}

double sphproof_kernel_w(double q, int dim)
{
    (void)dim;
    return evaluate(q, 0);
}

double sphproof_kernel_dw(double q, int dim)
{
    (void)dim;
    return evaluate(q, 1);
}
