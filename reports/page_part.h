/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of the page, each from its own file, in their order. Internal to pages. */
#ifndef SPHPROOF_PAGE_PART_H
#define SPHPROOF_PAGE_PART_H

#include <jansson.h>

#include "page_plot.h"

extern const char *const page_styles[]; /* parts of the style sheet; ends with NULL */

struct page;

/* All up to <body>, title: behind "sphproof"; and all from </main> on, which takes the writer.
 * False: no memory. */
void page_head(struct buffer *to, const char *title);
bool page_end(struct page_writer *writer, struct page *page);

/* One line for the head, and the section: what changed since last night and over the nights. */
void page_since(struct buffer *to, const json_t *results);
void page_history(struct page_writer *writer, const json_t *history);

void page_strip(struct page_writer *writer, const json_t *results);
void page_overview(struct page_writer *writer, const json_t *results);
void page_cases(struct page_writer *writer, const json_t *results);
void page_autopsies(struct page_writer *writer, const json_t *autopsies);
void page_skips(struct page_writer *writer, const json_t *skips);
/* of_codes: of a report of other codes. */
void page_bench(struct page_writer *writer, const json_t *bench, bool of_codes);
void page_codes(struct page_writer *writer, const json_t *results);
void page_gradients(struct page_writer *writer, const json_t *gradients);
void page_stress(struct page_writer *writer, const json_t *stress);
void page_claims(struct page_writer *writer, const json_t *claims);
void page_faults(struct page_writer *writer, const json_t *results);
void page_score(struct page_writer *writer, const json_t *score);
void page_kernels(struct page_writer *writer, const json_t *kernels);
void page_checks(struct page_writer *writer, const json_t *verify);
void page_detection(struct page_writer *writer, const json_t *verify);

#endif
