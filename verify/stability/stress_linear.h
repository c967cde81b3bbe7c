/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells of linear theory: what the eigenvalues say (stability.h), and the same found once more by
 * runs of the solver from a lattice with noise of 1e-6 spacings. */
#ifndef SPHPROOF_STRESS_LINEAR_H
#define SPHPROOF_STRESS_LINEAR_H

#include <jansson.h>

#include "stress_cell.h"

/* Computes a cell of kind STRESS_LIMIT, STRESS_STEP or STRESS_PAIRING: its stress_outcome. */
enum status stress_linear(const struct stress_cell *cell, json_t **document, struct error *error);

/* Growth rate of the fastest wave over eta, for every kernel and gradient: {"eta": [...], "rows":
 * [{"kernel", "gradient", "growth": [...]}]}. New reference. */
json_t *stress_linear_atlas(void);

#endif
