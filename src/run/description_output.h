/* SPDX-License-Identifier: GPL-3.0-or-later
 * What is said of the matrices of a state, in documents and on a terminal. */
#ifndef SPHPROOF_DESCRIPTION_OUTPUT_H
#define SPHPROOF_DESCRIPTION_OUTPUT_H

#include <jansson.h>

#include "description.h"

enum { DESCRIPTION_TEXT = 200 };

/* "matrix" of a document: {"condition": {"max", "mean"}, "angle": {"max", "mean"}, "fallen_back"};
 * null where the gradient needs no matrix. New reference. */
json_t *description_json(const struct description_sums *sums);

/* One line without its end; "" where the gradient needs no matrix. */
void description_text(const struct description_sums *sums, size_t n, char text[DESCRIPTION_TEXT]);

#endif
