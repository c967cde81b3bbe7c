/* SPDX-License-Identifier: GPL-3.0-or-later
 * Error budget of a Riemann problem: which region of the flow the L1 error of density comes from,
 * how fast each part falls, and whether still gas has stayed still. Internal to pages. */
#ifndef SPHPROOF_PAGE_BUDGET_H
#define SPHPROOF_PAGE_BUDGET_H

#include <jansson.h>

#include "page_plot.h"

/* Of these studies; nothing where it is not known. */
void page_budget(struct page_writer *writer, const json_t *const *documents, size_t count);

#endif
