/* SPDX-License-Identifier: GPL-3.0-or-later
 * A second implementation of the gradient operators, straight from their formulas: every pair, long
 * double, one matrix inverted by cofactors. Shares only the kernel's shape with src. An oracle for
 * the fast loops; with one fault switched on, the wrong operators that checks must reject. */
#pragma once

#include "operator.h"

#define NAIVE_FAULT_LIST(FAULT)                                                                    \
    FAULT(NONE, "no fault")                                                                        \
    FAULT(TRANSPOSED, "inverse matrix transposed")                                                 \
    FAULT(IDENTITY, "identity in place of the inverse matrix")                                     \
    FAULT(NO_SUBTRACTION, "difference form without subtracting f_i")                               \
    FAULT(NO_GRADIENT_CORRECTION, "normalised kernel without the matrix")                          \
    FAULT(NO_NORMALISATION, "matrix without the normalised kernel")                                \
    FAULT(NO_NORMALISATION_GRADIENT, "W/S with the derivative of S left out")                      \
    FAULT(DETERMINANT_SIGN, "3D determinant with the wrong sign on both tau_12 terms")             \
    FAULT(WIDTH_1D, "h = eta volume in every dimension")                                           \
    FAULT(WIDTH_OF_NEIGHBOUR, "kernel at the neighbour's h: scatter for gather")                   \
    FAULT(SIGN, "gradient with respect to the neighbour's position")                               \
    FAULT(NO_VOLUME, "volumes left out of the matrix")                                             \
    FAULT(SHORT_SUPPORT, "neighbours cut at 0.9 h")                                                \
    FAULT(POWER_OF_H, "h^-d for h^-(d+1) in dW/dr")                                                \
    FAULT(DIAGONAL, "off-diagonal elements of the matrix dropped")                                 \
    FAULT(SELF_WITHOUT, "the point itself left out of S")                                          \
    FAULT(ABSOLUTE, "r_j for r_j - r_i in the matrix")                                             \
    FAULT(FLOAT, "sums kept in single precision")                                                  \
    FAULT(HALF, "half of every pair")

enum naive_fault {
#define FAULT(name, text) NAIVE_##name,
    NAIVE_FAULT_LIST(FAULT)
#undef FAULT
};

/* Gradient of f at point i: dim values (periodic: nearest images only, h <= length/2); NaN where
 * the matrix has determinant 0. */
void naive_gradient(const struct operator_form *form, const struct kernel *kernel,
                    enum naive_fault fault, const struct cloud *cloud, const double *f, size_t i,
                    double *gradient);
