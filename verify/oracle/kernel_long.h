/* SPDX-License-Identifier: GPL-3.0-or-later
 * The built-in kernels evaluated in long double, for the rounding errors of the double ones. */
#pragma once

#include "kernel.h"

typedef long double kernel_long_shape(const struct kernel *kernel, long double q, int dim);

/* Both NULL if there is no built-in kernel of that name. */
void kernel_long_find(const char *name, kernel_long_shape **w, kernel_long_shape **dw);
