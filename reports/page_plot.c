/* SPDX-License-Identifier: GPL-3.0-or-later
 * A plot within the page, and its script and data for beside the page. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page_part.h"

static void keep(struct page *page, struct buffer *failed, const char *name, const char *ending,
                 char *bytes)
{
    struct buffer file = {0};
    buffer_format(&file, "%s.%s", name, ending);
    struct page_file *files = realloc(page->files, (page->file_count + 1) * sizeof *page->files);
    if (files) page->files = files;
    if (!files || file.failed || !bytes) {
        failed->failed = true;
        buffer_free(&file);
        free(bytes);
        return;
    }
    page->files[page->file_count++] = (struct page_file){buffer_take(&file), bytes};
}

void page_plot(struct page_writer *writer, const struct plot *plot, const char *caption)
{
    struct buffer *to = &writer->to;
    char *svg = NULL, message[512] = "", *script, *data;
    buffer_add(to, "<figure>");
    enum plot_status status = PLOT_NO_GNUPLOT;
    if (!writer->no_gnuplot) status = plot_svg(plot, &svg, message, sizeof message);
    if (status == PLOT_OK) {
        buffer_add(to, svg);
    } else {
        if (!writer->page->plots_missing++)
            snprintf(writer->page->message, sizeof writer->page->message, "%s", message);
        buffer_add(to, "<p class=\"missing\">");
        buffer_escape(to, writer->no_gnuplot ? writer->page->message : message);
        writer->no_gnuplot |= status == PLOT_NO_GNUPLOT;
        buffer_add(to, "</p>");
    }
    free(svg);
    buffer_add(to, "<figcaption>");
    buffer_escape(to, caption);
    buffer_format(to,
                  " <span class=\"files\"><a href=\"plots/%s.dat\">data</a>, "
                  "<a href=\"plots/%s.gp\">script</a></span></figcaption></figure>\n",
                  plot->name, plot->name);
    if (!plot_source(plot, &script, &data)) {
        to->failed = true;
        return;
    }
    keep(writer->page, to, plot->name, "gp", script);
    keep(writer->page, to, plot->name, "dat", data);
}

void page_plot_name(char *name, size_t size, const char *case_name, const char *what)
{
    snprintf(name, size, "%.60s-%s", case_name, what);
    for (char *c = name; *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-", *c))
            *c = '_';
    if (*name == '_' || *name == '-' || (*name >= '0' && *name <= '9')) *name = 'c';
}
