/* SPDX-License-Identifier: GPL-3.0-or-later
 * What belongs to a run, in documents and for plots. What is returned is a new reference. */
#pragma once

#include <jansson.h>

#include "description.h"
#include "run.h"
#include "settings.h"
#include "trace.h"

/* All keys as used: numbers, names, "rho v P" as an array. Keys of other problems are left out. New
 * reference. */
json_t *settings_json(const struct settings *settings);

enum { DESCRIPTION_TEXT = 200 };

/* "matrix" of a document: {"condition": {"max", "mean"}, "angle": {"max", "mean"}, "fallen_back"};
 * null where the gradient needs no matrix. New reference. */
json_t *description_json(const struct description_sums *sums);

/* One line without its end; "" where the gradient needs no matrix. */
void description_text(const struct description_sums *sums, size_t n, char text[DESCRIPTION_TEXT]);

/* {"nearest", "spread", "paired", "density", "gradient"}. New reference. */
json_t *trace_regularity_json(const struct regularity *regularity);

/* {"time", "mass", "momentum", "angular_momentum" (null in 1D), "energy": arrays of the drift;
 * "kinetic", "potential": what each has gained since the start, over the energy at the start, the
 * latter all that is not kinetic;
 * "regularity": {"time", and the figures of trace_regularity_json}}. New reference. */
json_t *trace_json(const struct trace *trace, int dim);

/* {"x", "density", "velocity", "pressure", "exact_density", ...: arrays, "exact": {"x", "density",
 * ...}}; reports/verdict.h says more. New reference. */
json_t *profile_json(const struct run_result *result);

/* {"dim", "map": {"x", "y": centres of cells, "slice": [from, to] of z (3D), "density", "speed",
 * "error" (|v - exact|, where it is known): by rows, NaN in a void}, "over": "x" or "R",
 * "quantities": names, "x": of some particles of the window, NAME, "exact_NAME": arrays, "exact":
 * {"x", NAME ...}}; from "over" on only where there is such a curve. New reference; NULL: no
 * memory. */
json_t *cloud_profile_json(const struct run_result *result);
