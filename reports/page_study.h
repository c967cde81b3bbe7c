/* SPDX-License-Identifier: GPL-3.0-or-later
 * Convergence of one case: errors over n with fitted and reference slopes, orders and gates.
 * Internal to pages. */
#ifndef SPHPROOF_PAGE_STUDY_H
#define SPHPROOF_PAGE_STUDY_H

#include <jansson.h>

#include "page_plot.h"

/* Plot and tables of the studies (converge documents) of one case. */
void page_study(struct page_writer *writer, const char *case_name, const json_t *const *documents,
                size_t count);

/* The order of the quantity that the case is judged by first, or NULL. */
const json_t *page_study_main(const json_t *document);

/* The quantity of an order, such as "L1(density)". */
void page_study_name(struct buffer *to, const json_t *order);

/* The error of that first quantity at the finest level. */
double page_study_finest(const json_t *document);

/* The entry of a converge document for a field and a norm, or NULL. */
const json_t *page_study_order(const json_t *document, const char *field, const char *norm);

#endif
