/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run is judged by: errors, error budget, suspicions and functionals of its snapshot. */
#ifndef SPHPROOF_RUN_MEASURE_H
#define SPHPROOF_RUN_MEASURE_H

#include "run.h"

/* Of result->snapshot at result->time. STATUS_ENVIRONMENT: no memory. */
enum status run_measure_errors(struct run_result *result, struct error *error);

/* Splits the L1 norms by the regions of the problem; exact_values[f]: n numbers of field f at the
 * particles. */
void run_measure_budget(const struct prepared *p, const struct snapshot *s,
                        const double *const *exact_values, struct budget *budget);

/* Errors where there is nothing to measure: NaN. */
void run_measure_nothing(struct run_result *result);

/* Those of the problem that are there with its settings, and the rate of what grows. */
void run_measure_functionals(struct run_result *result);

#endif
