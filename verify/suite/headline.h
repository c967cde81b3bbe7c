/* SPDX-License-Identifier: GPL-3.0-or-later
 * What failed, in a line for each member: a wrong kernel fails in dozens of figures, and they are
 * one fault. A member is what a figure's subject begins with, up to its first comma or colon. */
#ifndef SPHPROOF_HEADLINE_H
#define SPHPROOF_HEADLINE_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "suite.h"

/* [{"rank", "group", "check", "member", "headline", "property", "place", "value", "bound", "ratio",
 * "figures", "also": [checks], "command", "data"}]: one for each member that failed and each mutant
 * that was missed, what is most specific and fails most clearly first. check, value, bound, place
 * are those of the figure that says most; data: the name of its files (suite_output_failures),
 * without their endings. New reference; NULL: no memory. */
json_t *headline_list(const struct suite *suite);

/* For people: each headline, and below it how far over the bound, where, and what else fails. */
void headline_print(const json_t *headlines, FILE *stream, bool color);

#endif
