/* SPDX-License-Identifier: GPL-3.0-or-later
 * The report as a single self-contained HTML page, made from its results (see verdict.h). Reads
 * results only; writes no files. */
#pragma once

#include <jansson.h>

#include "page_plot.h"

struct page {
    char *html;
    struct page_plots plots;
};

/* results: including the verdict. False: no memory, and page is empty. */
bool page_make(struct page *page, const json_t *results);

/* The same for a document of `sphproof judge` whose snapshots have profiles (verdict.h). */
bool page_make_judge(struct page *page, const json_t *document);

/* The same for a document of `sphproof compare` whose first draws have profiles. */
bool page_make_compare(struct page *page, const json_t *document);
void page_free(struct page *page);
