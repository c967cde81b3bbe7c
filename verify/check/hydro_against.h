/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares the solver with the oracle (all pairs in long double) in 1D to 3D, for every quantity of
 * one evaluation or of the state some steps later. */
#pragma once

#include <stddef.h>

#include "check.h"
#include "simulation.h"

/* A fault in the setup of the solver alone, not of the oracle: one double or choice becomes `times`
 * its value plus `plus`, or a function changes the setup. {0}: no fault. */
struct hydro_fault {
    size_t at, size; /* offset and size of the member in struct setup */
    double times, plus;
    void (*spoil)(struct setup *setup);
};
#define HYDRO_TIMES(member, factor)                                                                \
    {                                                                                              \
        offsetof(struct setup, member), sizeof(((struct setup *)0)->member), factor, 0, NULL       \
    }
#define HYDRO_SET(member, value)                                                                   \
    {                                                                                              \
        offsetof(struct setup, member), sizeof(((struct setup *)0)->member), 0, value, NULL        \
    }

void hydro_put_fault(const struct hydro_fault *fault, struct setup *setup);

/* Compares density, smoothing length, pressure, volume, force, rates of energy and alpha, and the
 * time step. Skips a scheme that the solver refuses, or that the oracle does not know. */
void hydro_against_rates(struct check_run *run, struct setup setup, const struct hydro_fault *fault,
                         const char *where);

/* Compares the state and the number of steps after `steps` times the first time step. */
void hydro_against_steps(struct check_run *run, struct setup setup, const struct hydro_fault *fault,
                         double steps, const char *where);
