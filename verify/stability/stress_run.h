/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells that are one run: against the exact solution, or of a still box for long. */
#ifndef SPHPROOF_STRESS_RUN_H
#define SPHPROOF_STRESS_RUN_H

#include <jansson.h>

#include "stress_cell.h"

/* Stops a run that has used up its steps. */
struct stress_watch {
    uint64_t budget;
    double first_step, last_step, last_time; /* mean time steps of the first and last 32 */
    bool out_of_steps;
};

/* The stress_outcome of a run that has ended, or was stopped. */
typedef json_t *stress_judge_run(const struct stress_cell *cell, const struct run_result *result,
                                 const struct stress_watch *watch);

/* The outcome of a run that broke down, did not notice that it should have, or had no steps left
 * (measured is then shown); NULL: none of these. */
json_t *stress_unsound(const struct run_result *result, const struct stress_watch *watch,
                       double measured);

/* Runs a cell; one whose settings are refused has that outcome. */
enum status stress_execute(const struct stress_cell *cell, stress_judge_run *judge,
                           json_t **document, struct error *error);

/* Computes a cell of kind STRESS_RUN or STRESS_DRIFT: its stress_outcome. */
enum status stress_run(const struct stress_cell *cell, json_t **document, struct error *error);

#endif
