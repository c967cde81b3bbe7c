/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the parts of the page write to: its text, and its plots, whose scripts and data belong
 * beside it. */
#ifndef SPHPROOF_PAGE_PLOT_H
#define SPHPROOF_PAGE_PLOT_H

#include "buffer.h"
#include "plot.h"

enum { PAGE_SCHEMES = PLOT_COLORS }; /* of one case, at most */

struct page_file {
    char *name; /* NAME.gp, NAME.dat */
    char *bytes;
};

struct page_plots {
    struct page_file *files;
    size_t file_count;
    size_t missing; /* the page says where; message is the first one's reason */
    char message[512];
    bool no_gnuplot; /* found out; it is not asked again */
};
void page_plots_free(struct page_plots *plots);

struct page_writer {
    struct buffer to;
    struct page_plots plots;
    bool alone; /* nothing will lie beside the page */
};

/* Draws and inlines a plot as <figure>; keeps its sources for beside the page. One that cannot be
 * drawn leaves a note. */
void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption);

/* "CASE-WHAT" as a plot's name: what is not allowed there becomes '_'. */
void page_plot_name(char *name, size_t size, const char *case_name, const char *what);

#endif
