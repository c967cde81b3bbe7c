/* SPDX-License-Identifier: GPL-3.0-or-later
 * The smooth shear layers of McNally, Lyra & Passy 2012, ApJS 201, 18: two streams of densities 1
 * and 2 in the unit square, joined by exponentials of width 1/40, stirred by v_y = 0.01 sin(4 pi
 * x). The box is periodic, gamma = 5/3, P = 5/2. Any number of runs agree on how the mode grows,
 * until t = 1.5. */
#pragma once

struct kelvin_helmholtz_state {
    double rho, v[2], P;
};

/* The start, at x and y in the unit square. */
struct kelvin_helmholtz_state kelvin_helmholtz_start(double x, double y);

/* The amplitude of the mode as McNally et al. define it, M = 2 hypot(sum w v_y sin(4 pi x) E, sum w
 * v_y cos(4 pi x) E) / sum w E, E = exp(-4 pi |y - 1/4|) for y < 1/2, exp(-4 pi |3/4 - y|) above,
 * of n points with volumes w. */
double kelvin_helmholtz_amplitude(unsigned long n, const double *x, const double *y,
                                  const double *vy, const double *w);

/* The amplitude in their finest run, 4096 x 4096, by cubic splines in ln M between the times of its
 * table (every 0.1); NaN outside 0 <= t <= 1.5. */
double kelvin_helmholtz_reference(double t);
