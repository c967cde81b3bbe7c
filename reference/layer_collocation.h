/* SPDX-License-Identifier: GPL-3.0-or-later
 * The growth of a layer's modes by collocation: a first guess for, and a check of, the shooting of
 * layer_mode.h. */
#pragma once

#include <complex.h>

#include "layer.h"

/* omega of the fastest growing mode: eigenvalues of the primitive equations at this number of
 * Chebyshev points (>= 8). 0: no growing mode; NaN: no memory. */
double complex layer_mode_collocation(const struct layer *layer, int points);
