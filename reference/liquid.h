/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact flows of viscous liquids and of liquids under gravity, for tests of weakly compressible
 * SPH. Any consistent units of length, time and speed. */
#pragma once

/* Between plates at y = 0, at rest, and y = 1, which moves with speed 1 from t = 0 on: the speed
 * along the plates at 0 <= y <= 1 and t >= 0 in units of H^2/nu (Couette flow that starts from
 * rest; Morris, Fox & Zhu 1997). To 1e-15. */
double liquid_couette(double y, double t);

/* Between plates at rest, from t = 0 on under a force along them: the speed in units of F H^2/nu
 * (Poiseuille flow that starts from rest; Morris, Fox & Zhu 1997). To 1e-15. */
double liquid_poiseuille(double y, double t);

/* Means of these speeds over y. */
double liquid_couette_mean(double t);
double liquid_poiseuille_mean(double t);

/* Gravity waves of small amplitude on a liquid of depth H over a flat bottom (Lamb 1932, section
 * 228): the angular frequency of wavenumber k. */
double liquid_wave_frequency(double k, double depth, double gravity);

/* Components of the velocity for an upward speed cos(k x) of the surface; y: height above the
 * bottom. */
void liquid_wave_mode(double k, double depth, double x, double y, double v[2]);
