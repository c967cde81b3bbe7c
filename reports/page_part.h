/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts of the page in their order, one in each source file. Internal to pages. */
#pragma once

#include <jansson.h>

#include "buffer.h"
#include "page_plot.h"

extern const char *const page_styles[]; /* parts of the style sheet; NULL-terminated */

struct page;

/* page_head writes everything up to <body>; title follows "sphproof". page_end writes everything
 * from </main> on and takes over the contents of the writer. False: no memory. */
void page_head(struct buffer *to, const char *title);
bool page_end(struct page_writer *writer, struct page *page);

/* A line for the head of the page, and the same as plain text: changes since the previous night. */
void page_since(struct buffer *to, const json_t *results);
void page_since_plain(struct buffer *to, const json_t *results);

/* True of a report of other codes. */
bool page_of_codes(const json_t *results);

/* Sections of the page; those that page.c lists are only called if the results have their member.
 */
void page_strip(struct page_writer *writer, const json_t *results);
void page_codes(struct page_writer *writer, const json_t *results);
void page_cases(struct page_writer *writer, const json_t *results);
void page_history(struct page_writer *writer, const json_t *results);
void page_overview(struct page_writer *writer, const json_t *results);
void page_bench(struct page_writer *writer, const json_t *results);
void page_autopsies(struct page_writer *writer, const json_t *results);
void page_skips(struct page_writer *writer, const json_t *results);
void page_gradients(struct page_writer *writer, const json_t *results);
void page_stress(struct page_writer *writer, const json_t *results);
void page_claims(struct page_writer *writer, const json_t *results);
void page_faults(struct page_writer *writer, const json_t *results);
void page_score(struct page_writer *writer, const json_t *results);
void page_kernels(struct page_writer *writer, const json_t *results);
void page_checks(struct page_writer *writer, const json_t *results);
void page_detection(struct page_writer *writer, const json_t *results);

/* Convergence of a case from its studies (converge documents): errors against n with fitted and
 * reference slopes, orders and gates. */
void page_study(struct page_writer *writer, const char *case_name, const json_t *const *documents,
                size_t count);

/* The order of the main quantity of the case, or NULL. */
const json_t *page_study_main(const json_t *document);

/* Writes the quantity of an order, such as "L1(density)". */
void page_study_name(struct buffer *to, const json_t *order);

/* The error of the main quantity at the finest level. */
double page_study_finest(const json_t *document);

/* The entry of a converge document for a field and a norm, or NULL. */
const json_t *page_study_order(const json_t *document, const char *field, const char *norm);

/* The L1 error of density by regions of the flow in these studies, how fast each part decreases,
 * and whether undisturbed gas is unchanged; writes nothing if unknown. */
void page_budget(struct page_writer *writer, const json_t *const *documents, size_t count);

/* Time series of the runs of a case: drift of momentum, angular momentum and energy, and regularity
 * of the particles. */
void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count);

/* Figures for the runs (run documents) of a case: maps of the first run, maps of all errors on the
 * same colour scale (of all densities without an exact solution), and all runs with the exact
 * curve. all_maps: every map of every run, on common colour scales, instead of those of the first
 * run. The element <div class="figures"> is left open, so that the caller can add figures. */
void page_cloud_plots(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      size_t count, bool all_maps);

/* Tables of errors, conservation and cost, and of scalars with their exact values. */
void page_cloud_tables(struct buffer *to, const json_t *const *runs, size_t count);

/* Folded parts of a page: their HTML is compressed (zlib, base64), and a small script in the page
 * inflates it when a reader opens the part. Without zlib the HTML is left as it is. */

/* Compresses the text added to the buffer since `start`, which must be directly inside a <details>
 * element. */
void fold_seal(struct buffer *to, size_t start);

/* The text since `start` must be <section ...><h2>...</h2>...</section>: folds and compresses
 * everything after its heading. */
void fold_section(struct buffer *to, size_t start);

/* For the end of the page: inflates parts that are opened, and the target of a link. */
extern const char fold_script[];
