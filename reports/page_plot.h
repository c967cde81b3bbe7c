/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the parts of the page write to: its text, and its plots, whose scripts and data stand beside
 * the page. */
#pragma once

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
    bool no_gnuplot; /* it was missing once, and is not tried again */
};
void page_plots_free(struct page_plots *plots);

struct page_writer {
    struct buffer to;
    struct page_plots plots;
    struct plot_pen pen;
    bool alone; /* nothing will lie beside the page */
};

/* Draws a plot into the page as <figure>, and keeps its script and data, to be written beside the
 * page. In place of a plot that cannot be drawn there is a note. */
void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption);

/* Makes "CASE-WHAT" a plot's name, with '_' for characters that are not allowed there. */
void page_plot_name(char *name, size_t size, const char *case_name, const char *what);
