/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of a run, each from its own file. Internal to runs. */
#pragma once

#include "run.h"

struct initial;

/* Runs the core solver, or the solver that was asked for, to setup->t_end, and measures the state
 * there. setup: of the run and initial. STATUS_OK also where it breaks down: result->status tells
 * that. initial may be freed on the way.
 */
enum status run_simulate(const struct run *run, const struct setup *setup, struct initial *initial,
                         struct run_result *result, struct error *error);

/* Copies a snapshot, which may be the solver's own memory, into result->snapshot: in 1D by
 * position, in 2D and 3D by number. Sets the time, the spacing, and how many neighbours have
 * crossed. run_free it. STATUS_ENVIRONMENT: no memory. */
enum status run_keep(struct run_result *result, const struct snapshot *snapshot,
                     struct error *error);

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
