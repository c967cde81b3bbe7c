/* SPDX-License-Identifier: GPL-3.0-or-later
 * The solver against the oracle, all pairs in long double, in 1D to 3D: every quantity of one
 * evaluation, or of the state some steps later, is measured. */
#ifndef SPHPROOF_HYDRO_AGAINST_H
#define SPHPROOF_HYDRO_AGAINST_H

#include "check.h"
#include "simulation.h"

/* What a mutant does to the setup that the solver gets, and only the solver; or NULL. */
typedef void hydro_spoil(struct setup *setup);

/* Density, smoothing length, pressure, volume, force, rates of energy and alpha, and the time step.
 * A scheme that the solver refuses, or of which the oracle lacks a choice, is skipped. */
void hydro_against_rates(struct check_run *run, struct setup setup, hydro_spoil *spoil,
                         const char *where);

/* The state and the number of steps after this many of the first time step. */
void hydro_against_steps(struct check_run *run, struct setup setup, hydro_spoil *spoil,
                         double steps, const char *where);

#endif
