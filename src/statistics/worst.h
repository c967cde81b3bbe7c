/* SPDX-License-Identifier: GPL-3.0-or-later
 * The worst of many figures. Neither fmax nor `if (!(value <= worst)) worst = value` will do: the
 * first drops a NaN, the second forgets it at the next number. */
#pragma once

#include <math.h>

/* Keeps the larger one in *worst; a NaN is taken and stays. */
static inline void worst_keep(double *worst, double value)
{
    if (!(value <= *worst) && !isnan(*worst)) *worst = value;
}
