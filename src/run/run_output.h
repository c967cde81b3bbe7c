/* SPDX-License-Identifier: GPL-3.0-or-later
 * JSON members of a run, for documents and plots. Functions return new references. */
#pragma once

#include <jansson.h>

#include "description.h"
#include "run.h"
#include "settings.h"
#include "trace.h"

/* All keys of the problem with the values used: numbers, names, "rho v P" as an array. New
 * reference. */
json_t *settings_json(const struct settings *settings);

enum { DESCRIPTION_TEXT = 200 };

/* "matrix" of a document: {"condition": {"max", "mean"}, "angle": {"max", "mean"}, "fallen_back"};
 * null where the gradient needs no matrix. New reference. */
json_t *description_json(const struct description_sums *sums);

/* One line without a newline; "" if the gradient needs no matrix. */
void description_text(const struct description_sums *sums, size_t n, char text[DESCRIPTION_TEXT]);

/* {"nearest", "spread", "paired", "density", "gradient"}. New reference. */
json_t *trace_regularity_json(const struct regularity *regularity);

/* {"time", "mass", "momentum", "angular_momentum" (null in 1D), "energy": arrays of the drift;
 * "kinetic", "potential": gains since the start over the initial total energy, where "potential" is
 * all energy that is not kinetic; "regularity": {"time", and the members of
 * trace_regularity_json}}. New reference. */
json_t *trace_json(const struct trace *trace, int dim);

/* In 1D {"x", "density", "velocity", "pressure", "exact_density", ...: arrays, "exact": {"x",
 * "density", ...}}; see reports/verdict.h. In 2D and 3D {"dim", "map": {"x", "y": cell centres,
 * "slice": [from, to] of z (3D), "density", "speed", "error" (|v - exact|, if known): by rows, NaN
 * in a void}, "over": "x" or "R", "quantities": names, "x": of some particles in the window, NAME,
 * "exact_NAME": arrays, "exact": {"x", NAME
 * ...}}; from "over" on only for problems with such a curve. New reference; NULL: no memory. */
json_t *profile_json(const struct run_result *result);
