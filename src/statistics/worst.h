/* SPDX-License-Identifier: GPL-3.0-or-later
 * The worst of many figures. fmax ignores NaN, and `if (!(value <= worst)) worst = value` forgets
 * it at the next number. */
#pragma once

#include <math.h>

/* Keeps the larger value in *worst; NaN is kept forever. */
static inline void worst_keep(double *worst, double value)
{
    if (!(value <= *worst) && !isnan(*worst)) *worst = value;
}
