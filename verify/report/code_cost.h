/* SPDX-License-Identifier: GPL-3.0-or-later
 * What an error costs, from studies that have been made anyway: errors of their levels over CPU
 * time. */
#ifndef SPHPROOF_CODE_COST_H
#define SPHPROOF_CODE_COST_H

#include <jansson.h>

/* Adds to results "bench": a document for each case of results' "studies", "schemes" and "points"
 * as those of `sphproof bench` have them, as far as levels say it. */
void code_cost_add(json_t *results);

#endif
