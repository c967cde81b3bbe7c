/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of the page, each from its own file. Internal to pages. */
#ifndef SPHPROOF_PAGE_PART_H
#define SPHPROOF_PAGE_PART_H

#include "buffer.h"
#include "page.h"
#include "plot.h"

struct page_writer {
    struct buffer to;
    struct page *page;
};

/* Draws and inlines a plot as <figure>; keeps its sources for beside the page. */
void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption);

void page_cases(struct page_writer *writer, const json_t *results);
void page_gradients(struct page_writer *writer, const json_t *gradients);
void page_kernels(struct page_writer *writer, const json_t *kernels);
void page_checks(struct page_writer *writer, const json_t *verify);
void page_detection(struct page_writer *writer, const json_t *verify);

extern const char *const page_style;

#endif
