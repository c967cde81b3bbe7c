/* SPDX-License-Identifier: GPL-3.0-or-later
 * Functionals (problem.h) that several problems have. */
#pragma once

#include "problem.h"

/* Means over the window, weighted with volume; in 1D. */
extern const struct functional functional_mean_internal_energy, functional_mean_pressure;

/* Of gas that should be at rest: sqrt(sum V (v/c)^2/sum V) over the window. */
extern const struct functional functional_velocity_rms;

/* Mean of a field of the particles over the window, weighted with volume. */
double functional_window_mean(const struct prepared *p, const struct snapshot *s,
                              const double *field);
