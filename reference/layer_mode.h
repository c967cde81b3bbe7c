/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growing modes of a smooth layer between two gases, exact while they are small: Kelvin &
 * Helmholtz's instability of a shear layer and Rayleigh & Taylor's of a stratified one. The base
 * state is rho(y), U(y) along x and P(y) with P' = -rho g; perturbations are the real part of
 * f(y) exp(i (k x - omega t)). With the displacement xi, v = i s xi, s = k U - omega and the
 * perturbation p of the pressure, the linearised equations of an ideal gas are
 *   xi' = (g/c^2) xi + [k^2/(rho s^2) - 1/(rho c^2)] p,
 *   p'  = rho (s^2 - N^2) xi - (g/c^2) p,   N^2 = -g (rho'/rho + g/c^2),
 *   u = -k p/(rho s) - U' xi,   rho_1 = p/c^2 - (rho' + rho g/c^2) xi
 * (Chandrasekhar 1961, chapters X and XI, with compressibility). They are solved by shooting from
 * both ends to the middle of the layer; layer_mode_collocation is a second way to omega. */
#pragma once

#include <complex.h>
#include <stdbool.h>

#include "layer.h"

enum { LAYER_MODE_NODES = 97 };

/* A perturbation: complex amplitudes, or real values. */
struct layer_amplitude {
    double complex rho, u, v, p, xi;
};
struct layer_values {
    double rho, v[2], p;
};

/* The mode that grows fastest, in the units in which the greatest |v(y)| is 1 and v(0) > 0. */
struct layer_mode {
    struct layer layer;
    double complex omega;
    double displacement;                                     /* the greatest |xi(y)| */
    double complex v[LAYER_MODE_NODES], p[LAYER_MODE_NODES]; /* Chebyshev coefficients */
};

/* By shooting (Runge & Kutta 8(9), secants to the complex root), to some 1e-11. False: no growing
 * mode was found; or no memory, then mode->omega is NaN. The layer is valid. */
bool layer_mode_find(const struct layer *layer, struct layer_mode *mode);

/* Amplitudes at y: within the walls, or anywhere in a periodic layer. */
struct layer_amplitude layer_mode_amplitude(const struct layer_mode *mode, double y);

/* The real perturbation at x, y, t. */
struct layer_values layer_mode_values(const struct layer_mode *mode, double x, double y, double t);
