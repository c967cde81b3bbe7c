/* SPDX-License-Identifier: GPL-3.0-or-later
 * Functionals (problem.h) shared by several problems. */
#pragma once

#include "problem.h"

/* Volume-weighted means over the window; 1D. */
extern const struct functional functional_mean_internal_energy, functional_mean_pressure;

/* For gas that should be at rest: sqrt(sum V (v/c)^2/sum V) over the window. */
extern const struct functional functional_velocity_rms;

/* Exact values of functionals that are 0, or 1, at any time. */
double functional_zero(const struct prepared *p, double t);
double functional_one(const struct prepared *p, double t);

/* Volume-weighted mean of a particle field over the window. */
double functional_window_mean(const struct prepared *p, const struct snapshot *s,
                              const double *field);
