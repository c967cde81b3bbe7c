/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells that ask what becomes of round-off: a run, and the same with its start moved a little. */
#ifndef SPHPROOF_STRESS_AMPLIFY_H
#define SPHPROOF_STRESS_AMPLIFY_H

#include <jansson.h>

#include "stress_cell.h"

/* Computes a cell of kind STRESS_AMPLIFY. Measured: the largest relative change of an error norm
 * (L1, L2 of every field) over that of the start, 1e-13 of the spacing. */
enum status stress_amplify(const struct stress_cell *cell, json_t **document, struct error *error);

#endif
