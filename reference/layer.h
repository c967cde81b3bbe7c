/* SPDX-License-Identifier: GPL-3.0-or-later
 * A smooth layer between two gases, its base state: rho(y), U(y) along x and P(y) with
 * P' = -rho g. */
#pragma once

#include <complex.h>
#include <stdbool.h>

/* The imaginary unit in double precision; I is a float. */
#define LAYER_I ((double complex)I)

/* T(y) is the step from -1 to 1: tanh(y/width) between walls at y = -+wall; or, periodic with
 * period 1, tanh(sin(2 pi y)/(2 pi width)), a step up at y = 0 and one down at 1/2. Any consistent
 * units. */
struct layer {
    double gamma, k, width;
    double rho, rho_step; /* density rho + rho_step T(y) */
    double U;             /* velocity U T(y) */
    double P, g;          /* pressure at y = 0; gravity along -y, 0 in a periodic layer */
    bool periodic;
    double wall;        /* where not periodic */
    bool pressure_node; /* periodic: p = 0 at y = -+1/4, where otherwise v = 0 */
};

struct layer_base {
    double rho, U, P, c2; /* c2: sound speed squared */
    double rho_dy, U_dy;  /* d/dy */
};

/* NULL, or a text that says what is wrong with a layer. */
const char *layer_fault(const struct layer *layer);

struct layer_base layer_base(const struct layer *layer, double y);
