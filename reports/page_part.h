/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of the page, each from its own file, in their order. Internal to pages. */
#pragma once

#include <jansson.h>

#include "buffer.h"
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

/* Convergence of one case, from its studies (converge documents): errors over n with fitted and
 * reference slopes, orders and gates. */
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

/* Which region of the flow the L1 error of density comes from in these studies, how fast each part
 * falls, and whether still gas has stayed still; nothing where it is not known. */
void page_budget(struct page_writer *writer, const json_t *const *documents, size_t count);

/* Runs of a case through time: momentum, angular momentum and energy against their start; how
 * regular their particles stand. */
void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count);

/* Pictures of the runs (run documents) of one case: maps of the first run, maps of all errors on
 * one colour scale (of all densities where there is no exact solution), and all runs over the exact
 * curve. all_maps: every map of every run, on common colour scales, in place of those of the first
 * run. The element <div class="figures"> is left open, so that the caller can add figures. */
void page_cloud_plots(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      size_t count, bool all_maps);

/* Errors, conservation and cost, and scalars beside their exact values. */
void page_cloud_tables(struct buffer *to, const json_t *const *runs, size_t count);

/* Folded parts of a page: their HTML is compressed data (zlib, base64), which a small script in the
 * page inflates when a reader opens them. Without zlib they stand in the page as they are. */

/* What was added to the buffer since `start` becomes a sealed part; it stands directly within a
 * <details> element, which opens it. */
void fold_seal(struct buffer *to, size_t start);

/* What was added since `start` is <section ...><h2>...</h2>...</section>: everything behind its
 * heading is folded and sealed. */
void fold_section(struct buffer *to, size_t start);

/* For the page's end: inflates what is opened, and what a link leads to. */
extern const char fold_script[];
