/* SPDX-License-Identifier: GPL-3.0-or-later
 * State of a case in a report, which is that of its first scheme unless something failed. Internal
 * to pages. */
#pragma once

#include <jansson.h>

#include "buffer.h"

/* Finds the document of a case and a scheme in a list of runs or studies; label NULL: the first of
 * the case. NULL: there is none. */
const json_t *case_state_find(const json_t *list, const char *case_name, const char *label);

/* The distinct labels of the documents with this range of dimensions (1 if not given), in order; at
 * most PAGE_SCHEMES. */
size_t case_state_labels(const json_t *list, int least, int most, const char **labels);

/* "broke_down" or "fail" if any run or gate of the case did so, with any scheme. Else the state of
 * its first scheme: "smoke", "undetermined" or "known" if that is the state of a gate, else
 * "ok". */
const char *case_state(const json_t *results, const char *case_name);

/* Writes a cell with the name of the case and a link to it. */
void case_state_cell(struct buffer *to, const char *case_name);

/* The error of a study at level i by the name of a field (L1) or of a scalar (distance from its
 * exact value), and its finest level (NULL: none). */
double case_state_level_error(const json_t *study, const char *name, size_t i);
const json_t *case_state_finest(const json_t *study);

/* The quantity by which a run or a study is judged. */
const char *case_state_measured(const json_t *document);

/* The error by which a run is judged: L1 of a field, or the distance of a scalar from its exact
 * value. *name: its name. */
double case_state_error(const json_t *run, const char **name);
