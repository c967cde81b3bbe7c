/* SPDX-License-Identifier: GPL-3.0-or-later
 * The report as one self-contained HTML page, as JUnit XML and as a summary in Markdown, made from
 * its results (verdict.h says what they hold). Reads results only; writes no files. */
#ifndef SPHPROOF_PAGE_H
#define SPHPROOF_PAGE_H

#include <jansson.h>
#include <stddef.h>

/* What belongs beside the page: each plot's script and data. */
struct page_file {
    char *name; /* NAME.gp, NAME.dat */
    char *bytes;
};

struct page {
    char *html;
    struct page_file *files;
    size_t file_count;
    size_t plots_missing; /* the page says where; message is the first one's reason */
    char message[512];
};

/* results: with its verdict. False: no memory; page is then empty. A plot that cannot be drawn
 * leaves a note in the page. */
int page_make(struct page *page, const json_t *results);
void page_free(struct page *page);

/* Malloced strings; NULL: no memory. */
char *page_junit(const json_t *results);
char *page_summary(const json_t *results);

#endif
