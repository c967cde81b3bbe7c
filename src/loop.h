/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the stamped loops share. */
#ifndef SPHPROOF_LOOP_H
#define SPHPROOF_LOOP_H

#include "loops.h"
#include "stamp.h"

/* The tables of the four files of sums; kernel: position in kernels.def, -1: unstamped. */
density_loop *loop_density(int kernel, enum density_terms terms);
matrix_loop *loop_matrix(int kernel, enum matrix_terms terms);
gradient_loop *loop_gradient(int kernel, enum gradient gradient, int width);
force_loop *loop_force(bool stamped, enum formulation formulation, enum viscosity viscosity,
                       enum energy energy);

#endif
