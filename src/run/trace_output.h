/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is seen of a run through time, and how regular its particles stand, as JSON. */
#ifndef SPHPROOF_TRACE_OUTPUT_H
#define SPHPROOF_TRACE_OUTPUT_H

#include <jansson.h>

#include "trace.h"

/* {"nearest", "spread", "paired", "density", "gradient"}. New reference. */
json_t *trace_regularity_json(const struct regularity *regularity);

/* {"time", "mass", "momentum", "angular_momentum" (null in 1D), "energy": arrays of the drift;
 * "kinetic", "potential": what each has gained since the start, over the energy at the start, the
 * latter all that is not kinetic;
 * "regularity": {"time", and the figures of trace_regularity_json}}. New reference. */
json_t *trace_json(const struct trace *trace, int dim);

#endif
