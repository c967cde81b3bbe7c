/* SPDX-License-Identifier: GPL-3.0-or-later
 * Scalars of a run's final state, each with its exact value: means over the window, the place of a
 * shock, the amplitude of a mode. What Richardson's extrapolation is for. */
#ifndef SPHPROOF_FUNCTIONAL_H
#define SPHPROOF_FUNCTIONAL_H

#include "run.h"

/* Fills result->functionals and result->h from the snapshot. */
void functional_measure(struct run_result *result);

#endif
