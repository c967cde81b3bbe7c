/* SPDX-License-Identifier: GPL-3.0-or-later
 * Profiles of a run for plots: the particles of the window with the exact values at their places,
 * and the exact curve. */
#ifndef SPHPROOF_PROFILE_H
#define SPHPROOF_PROFILE_H

#include <jansson.h>

#include "run.h"

/* {"x", "density", "velocity", "pressure", "exact_density", ...: arrays, "exact": {"x", "density",
 * ...}}; reports/verdict.h says more. New reference. */
json_t *profile_json(const struct run_result *result);

#endif
