/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells that are one run: against the exact solution, or of a still box for long. */
#ifndef SPHPROOF_STRESS_RUN_H
#define SPHPROOF_STRESS_RUN_H

#include <jansson.h>

#include "stress_cell.h"

/* Computes a cell of kind STRESS_RUN or STRESS_DRIFT: its stress_outcome. */
enum status stress_run(const struct stress_cell *cell, json_t **document, struct error *error);

#endif
