/* SPDX-License-Identifier: GPL-3.0-or-later
 * Output of the parts of the page: the text, and the plots, whose scripts and data are written next
 * to the page. */
#pragma once

#include <jansson.h>

#include "buffer.h"
#include "plot.h"

enum { PAGE_SCHEMES = PLOT_COLORS }; /* most schemes of a case */

struct page_file {
    char *name; /* NAME.gp, NAME.dat */
    char *bytes;
};

struct page_plots {
    struct page_file *files;
    size_t file_count;
    size_t missing; /* plots that could not be drawn, each with a note in the page; message: reason
                       of the first */
    char message[512];
    bool no_gnuplot; /* gnuplot was not found and is not tried again */
};
void page_plots_free(struct page_plots *plots);

struct page_writer {
    struct buffer to;
    struct page_plots plots;
    struct plot_pen pen;
    bool alone; /* no files will be written next to the page */
};

/* Draws a plot into the page as <figure>, and keeps its script and data for files next to the page.
 * A plot that cannot be drawn is replaced by a note. */
void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption);

/* Makes a plot's name "CASE-WHAT", with '_' for characters that are not allowed. */
void page_plot_name(char *name, size_t size, const char *case_name, const char *what);

/* A table of n elements, all 0, and the numbers of a list (value_numbers), both malloced. Where
 * memory has ended, NULL, and the page fails. */
void *page_allocate(struct buffer *to, size_t n, size_t size);
double *page_numbers(struct buffer *to, const json_t *list, size_t *n);

/* Lists of numbers of one object, such as a profile; owned. Each has n numbers at least. */
enum { PAGE_COLUMNS = 5 };
struct page_columns {
    size_t n;
    double *of[PAGE_COLUMNS];
};

/* Reads the lists of these names. True if all are of the same length, and not empty. */
bool page_columns_read(struct buffer *to, struct page_columns *columns, const json_t *from,
                       const char *const *names, size_t count);
void page_columns_free(struct page_columns *columns);
