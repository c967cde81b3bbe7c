/* SPDX-License-Identifier: GPL-3.0-or-later
 * From the particles of a run to its errors: the solver is followed on its way, step by step. */
#ifndef SPHPROOF_RUN_SIMULATE_H
#define SPHPROOF_RUN_SIMULATE_H

#include "run.h"

struct initial;

/* Runs the core solver, or the solver that was asked for, to setup->t_end, and measures the state
 * there. setup: of the run and initial. STATUS_OK also where it breaks down: result->status tells
 * that. initial may be freed on the way.
 */
enum status run_simulate(const struct run *run, const struct setup *setup, struct initial *initial,
                         struct run_result *result, struct error *error);

#endif
