/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of the page, each from its own file. Internal to pages. */
#ifndef SPHPROOF_PAGE_PART_H
#define SPHPROOF_PAGE_PART_H

#include "buffer.h"
#include "page.h"
#include "plot.h"

enum { PAGE_SCHEMES = PLOT_COLORS }; /* of one case, at most */

struct page_writer {
    struct buffer to;
    struct page *page;
    bool no_gnuplot; /* found out; it is not asked again */
};

/* Draws and inlines a plot as <figure>; keeps its sources for beside the page. */
void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption);

/* "CASE-WHAT" as a plot's name: what is not allowed there becomes '_'. */
void page_plot_name(char *name, size_t size, const char *case_name, const char *what);

/* What the runs of one case have changed of what is conserved, through time. */
void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count);

/* The entry of a converge document for a field and a norm, or NULL. */
const json_t *page_order(const json_t *study, const char *field, const char *norm);

/* Plot and tables of the studies of one case. */
void page_convergence(struct page_writer *writer, const char *case_name,
                      const json_t *const *documents, size_t count);

/* Where the errors of these studies come from, by regions; nothing where that is not known. */
void page_budget(struct page_writer *writer, const json_t *const *documents, size_t count);

/* One line for the head, and the section: what changed since last night and over the nights. */
void page_since(struct buffer *to, const json_t *results);
void page_history(struct page_writer *writer, const json_t *history);

void page_overview(struct page_writer *writer, const json_t *results);
void page_cases(struct page_writer *writer, const json_t *results);
void page_bench(struct page_writer *writer, const json_t *bench);
void page_gradients(struct page_writer *writer, const json_t *gradients);
void page_stress(struct page_writer *writer, const json_t *stress);
void page_faults(struct page_writer *writer, const json_t *results);
void page_kernels(struct page_writer *writer, const json_t *kernels);
void page_checks(struct page_writer *writer, const json_t *verify);
void page_detection(struct page_writer *writer, const json_t *verify);

extern const char *const page_styles[]; /* parts of the style sheet; ends with NULL */

#endif
