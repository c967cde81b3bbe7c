/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "page_part.h"

#include <math.h>
#include <string.h>

#include "html.h"
#include "value.h"

static const json_t *budget_of(const json_t *document)
{
    return json_array_get(json_object_get(document, "budgets"), 0);
}

static void share_cell(struct buffer *to, const json_t *region)
{
    double share = value_member(region, "share"), order = value_member(region, "order");
    buffer_add(to, "<td class=\"n\">");
    if (share > 0) buffer_format(to, "%.0f %%", 100 * share);
    buffer_add(to, "</td><td class=\"n\">");
    if (share > 0 && isfinite(order)) html_order(to, region);
    buffer_add(to, "</td>");
}

static void still_row(struct buffer *to, const json_t *const *documents, size_t count)
{
    buffer_add(to, "<tr class=\"total\"><th>still gas moves at, of its sound speed</th>");
    for (size_t k = 0; k < count; k++) {
        const json_t *still = json_object_get(budget_of(documents[k]), "still_gas");
        const char *status = value_text(still, "status");
        if (json_is_number(json_object_get(still, "value")))
            html_cell_number(to, value_member(still, "value"));
        else
            html_cell(to, "—");
        buffer_add(to, "<td>");
        if (!strcmp(status, "pass") || !strcmp(status, "fail")) html_status(to, status);
        buffer_add(to, "</td>");
    }
    buffer_add(to, "</tr>\n");
}

void page_budget(struct page_writer *writer, const json_t *const *documents, size_t count)
{
    struct buffer *to = &writer->to, columns = {0};
    const json_t *regions = NULL, *region;
    size_t i;
    for (size_t k = 0; k < count && !regions; k++)
        regions = json_object_get(budget_of(documents[k]), "regions");
    if (!regions) return;
    buffer_add(&columns, "region");
    for (size_t k = 0; k < count; k++)
        html_format(&columns, "|#%s|#order", value_text(documents[k], "label"));
    buffer_add(to, "<details><summary>Where the error of density comes from, by region of the "
                   "flow</summary>\n");
    html_table(to, "budget", buffer_text(&columns, to));
    buffer_free(&columns);
    json_array_foreach(regions, i, region) {
        buffer_add(to, "<tr>");
        html_cell(to, value_text(region, "region"));
        for (size_t k = 0; k < count; k++)
            share_cell(to, json_array_get(json_object_get(budget_of(documents[k]), "regions"), i));
        buffer_add(to, "</tr>\n");
    }
    still_row(to, documents, count);
    html_table_end(to);
    buffer_add(to, "<p>Share of L1 at the finest level. Contact and shock reach three smoothing "
                   "lengths to either side; undisturbed gas is what no wave has passed.</p>"
                   "</details>\n");
}
