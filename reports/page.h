/* SPDX-License-Identifier: GPL-3.0-or-later
 * The report as one self-contained HTML page, made from its results (verdict.h says what they
 * hold). Reads results only; writes no files. */
#pragma once

#include <jansson.h>

#include "page_plot.h"

struct page {
    char *html;
    struct page_plots plots;
};

/* results: with its verdict. False: no memory; page is then empty. */
bool page_make(struct page *page, const json_t *results);

/* The same of a document of `sphproof judge` whose snapshots have profiles (verdict.h). */
bool page_make_judge(struct page *page, const json_t *document);

/* The same of a document of `sphproof compare` whose first draws have profiles. */
bool page_make_compare(struct page *page, const json_t *document);
void page_free(struct page *page);
