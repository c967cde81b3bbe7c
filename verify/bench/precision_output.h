/* SPDX-License-Identifier: GPL-3.0-or-later
 * A work-precision study for people and programs: tables on standard output, the plot, JSON. */
#ifndef SPHPROOF_PRECISION_OUTPUT_H
#define SPHPROOF_PRECISION_OUTPUT_H

#include <jansson.h>

#include "precision.h"
#include "table.h"

/* Schemes by figure of merit, the front, the cheapest ways. */
void precision_print(const struct precision *precision, const struct table_style *style);

/* Error against CPU time, curves named at their ends: both references and the schemes with points
 * on the front, as many as there are colours; all others as points. STATUS_ENVIRONMENT. */
enum status precision_plot(const struct precision *precision, const char *path,
                           struct error *error);

/* "case", "points", "schemes", "cheapest", "excluded" ... of a result document. */
void precision_add_json(const struct precision *precision, json_t *document);

#endif
