/* SPDX-License-Identifier: GPL-3.0-or-later
 * Autopsies of the error: conclusion, plot, and shares of the error at the finest level. */
#include <stdio.h>
#include <string.h>

#include "autopsy_plot.h"
#include "html.h"
#include "page_part.h"
#include "value.h"

enum { NAME = 96 };

static const struct html_column columns[] = {
    COLUMN("part", "part", .kind = CELL_WORDS),
    COLUMN("#L1 of the velocity", "error"),
    COLUMN("#share", "share", .format = "%.3f"),
    COLUMN("#its order", "order", .format = "%.2f", .otherwise = "—"),
    COLUMN("#from", "low", .format = "%.2f", .otherwise = "—"),
    COLUMN("#to", "high", .format = "%.2f", .otherwise = "—"),
    {.head = NULL},
};

static void shares(struct buffer *to, const json_t *document)
{
    const json_t *all = json_object_get(document, "shares"), *entry;
    const double finest = value_member(json_array_get(all, json_array_size(all) - 1), "n");
    json_t *list = json_array();
    size_t k;
    json_array_foreach(all, k, entry)
        if (value_member(entry, "n") == finest) json_array_append(list, (json_t *)entry);
    html_list(to, "costs", columns, list, NULL);
    json_decref(list);
}

void page_autopsies(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    size_t k;
    const json_t *document;
    buffer_add(
        to,
        "<section id=\"autopsies\"><h2>What orders are lost to</h2>\n<p>Where the solution is "
        "smooth, the error of the velocity is shared among its causes. What the time step costs is "
        "measured by runs with smaller steps. What gradient, volume elements, disorder and "
        "viscosity cost is measured on exact fields, at regular positions and at those of the "
        "run's particles at its end. The order of a cause is that of its share of the error, with "
        "its 95 % interval.</p>\n");
    json_array_foreach(json_object_get(results, "autopsies"), k, document) {
        char name[NAME], what[32];
        snprintf(what, sizeof what, "autopsy-%zu", k + 1);
        page_plot_name(name, sizeof name, value_text(document, "case"), what);
        html_format(to, "<p><b>%s</b>: %s</p>", value_text(document, "case"),
                    value_text(document, "sentence"));
        html_command(to, "see it again:", value_text(document, "reproduce"));
        buffer_add(to, "<div class=\"figures\">");
        autopsy_plot_page(writer, document, name);
        buffer_add(to, "</div>\n");
        shares(to, document);
    }
    buffer_add(to, "</section>\n");
}
