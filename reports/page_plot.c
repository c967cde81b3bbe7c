/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_plot.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "value.h"

void *page_allocate(struct buffer *to, size_t n, size_t size)
{
    void *table = calloc(n, size);
    to->failed |= n && !table;
    return table;
}

double *page_numbers(struct buffer *to, const json_t *list, size_t *n)
{
    double *numbers = value_numbers(list, n);
    to->failed |= *n < json_array_size(list);
    return numbers;
}

bool page_columns_read(struct buffer *to, struct page_columns *columns, const json_t *from,
                       const char *const *names, size_t count)
{
    bool whole = true;
    *columns = (struct page_columns){.n = SIZE_MAX};
    for (size_t k = 0; k < count; k++) {
        size_t n;
        columns->of[k] = page_numbers(to, json_object_get(from, names[k]), &n);
        whole = whole && n && (n == columns->n || k == 0);
        if (n < columns->n) columns->n = n;
    }
    return whole;
}

void page_columns_free(struct page_columns *columns)
{
    for (int k = 0; k < PAGE_COLUMNS; k++) free(columns->of[k]);
}

static void keep(struct page_writer *writer, const char *name, const char *ending, char *bytes)
{
    struct page_plots *plots = &writer->plots;
    struct buffer file = {0};
    buffer_format(&file, "%s.%s", name, ending);
    struct page_file *files = realloc(plots->files, (plots->file_count + 1) * sizeof *plots->files);
    if (files) plots->files = files;
    if (!files || file.failed || !bytes) {
        writer->to.failed = true;
        buffer_free(&file);
        free(bytes);
        return;
    }
    plots->files[plots->file_count++] = (struct page_file){buffer_take(&file), bytes};
}

void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption)
{
    struct buffer *to = &writer->to;
    struct page_plots *plots = &writer->plots;
    char *svg = NULL, message[512] = "", *script, *data;
    buffer_add(to, "<figure>");
    enum plot_status status = PLOT_NO_GNUPLOT;
    if (!plots->no_gnuplot) status = plot_svg(&writer->pen, plot, &svg, message, sizeof message);
    if (status == PLOT_OK) {
        buffer_add(to, svg);
    } else {
        if (!plots->missing++) snprintf(plots->message, sizeof plots->message, "%s", message);
        html_format(to, "<p class=\"missing\">%s</p>",
                    plots->no_gnuplot ? plots->message : message);
        plots->no_gnuplot |= status == PLOT_NO_GNUPLOT;
    }
    free(svg);
    html_format(to, "<figcaption>%s", caption);
    if (!writer->alone)
        buffer_format(to,
                      " <span class=\"files\"><a href=\"plots/%s.dat\">data</a>, "
                      "<a href=\"plots/%s.gp\">script</a></span>",
                      plot->name, plot->name);
    buffer_add(to, "</figcaption></figure>\n");
    if (writer->alone) return;
    plot_source(plot, &script, &data); /* NULL without memory */
    keep(writer, plot->name, "gp", script);
    keep(writer, plot->name, "dat", data);
}

void page_plots_free(struct page_plots *plots)
{
    for (size_t k = 0; k < plots->file_count; k++) {
        free(plots->files[k].name);
        free(plots->files[k].bytes);
    }
    free(plots->files);
    *plots = (struct page_plots){0};
}

void page_plot_name(char *name, size_t size, const char *case_name, const char *what)
{
    snprintf(name, size, "%.60s-%s", case_name, what);
    for (char *c = name; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-", *c))
            *c = '_';
    if (*name == '_' || *name == '-' || (*name >= '0' && *name <= '9')) *name = 'c';
}
