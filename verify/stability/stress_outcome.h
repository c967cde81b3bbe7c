/* SPDX-License-Identifier: GPL-3.0-or-later
 * How a cell ended, in JSON. */
#ifndef SPHPROOF_STRESS_OUTCOME_H
#define SPHPROOF_STRESS_OUTCOME_H

#include <jansson.h>

/* {"predicted", "measured", "outcome", "reason"}; not a number: null. New reference. */
json_t *stress_outcome(double predicted, double measured, const char *outcome, const char *reason);

/* The kind of breakdown that a run's message tells of, in few words. */
const char *stress_outcome_breakdown(const char *message);

#endif
