/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pages show of a run in 2D or 3D: maps in coarse cells, and particles over the exact curve
 * where the exact solution depends on one coordinate only, x or the distance from the middle. */
#ifndef SPHPROOF_CLOUD_PROFILE_H
#define SPHPROOF_CLOUD_PROFILE_H

#include <jansson.h>

#include "run.h"

/* {"dim", "map": {"x", "y": centres of cells, "slice": [from, to] of z (3D), "density", "speed",
 * "error" (|v - exact|, where it is known): by rows, NaN in a void}, "over": "x" or "R", "quantities": names, "x": of some particles of the
 * window, NAME, "exact_NAME": arrays, "exact": {"x", NAME ...}}; from "over" on only where there is
 * such a curve. New reference; NULL: no memory. */
json_t *cloud_profile_json(const struct run_result *result);

#endif
