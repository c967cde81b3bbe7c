/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a report says of a case as a whole, and of its first scheme, which stands for the case.
 * Internal to pages. */
#pragma once

#include <jansson.h>

#include "buffer.h"

/* The document of a case and a scheme in a list of runs or studies, or NULL if there is none; the
 * first one of the case if label is NULL. */
const json_t *case_state_find(const json_t *list, const char *case_name, const char *label);

/* The labels of the documents with this number of dimensions (1 where they give none), each once,
 * in the order in which they stand; at most PAGE_SCHEMES. */
size_t case_state_labels(const json_t *list, int least, int most, const char **labels);

/* "broke_down" or "fail" if any run or gate of the case did so, with any scheme. Else the state of
 * its first scheme: "smoke", "undetermined" or "known" if one of its gates is, else "ok". */
const char *case_state(const json_t *results, const char *case_name);

/* A cell with the case's name, which is a link to the case. */
void case_state_cell(struct buffer *to, const char *case_name);

/* What a run is judged by: L1 of a field, or the distance of a scalar from its exact value. *name:
 * what it is. */
double case_state_error(const json_t *run, const char **name);
