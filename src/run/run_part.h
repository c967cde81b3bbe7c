/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts of a run, one in each source file. Internal to runs. */
#pragma once

#include "run.h"

struct initial;

/* Runs the core solver, or the solver that was asked for, to setup->t_end, and measures the final
 * state. setup: made from run and initial. Returns STATUS_OK also after a breakdown, which is
 * recorded in result->status. May free initial before it returns. */
enum status run_simulate(const struct run *run, const struct setup *setup, struct initial *initial,
                         struct run_result *result, struct error *error);

/* Copies a snapshot, which may be the solver's own memory, into result->snapshot: in 1D ordered by
 * position, in 2D and 3D by particle number. Sets the time, the spacing and the number of crossed
 * neighbours. Free with run_free. STATUS_ENVIRONMENT: no memory. */
enum status run_keep(struct run_result *result, const struct snapshot *snapshot,
                     struct error *error);

/* Measures the errors of result->snapshot at result->time. STATUS_ENVIRONMENT: no memory. */
enum status run_measure_errors(struct run_result *result, struct error *error);

/* Sets all errors to NaN. */
void run_measure_nothing(struct run_result *result);

/* Measures the functionals that exist for the problem's settings, and the growth rate. */
void run_measure_functionals(struct run_result *result);
