/* SPDX-License-Identifier: GPL-3.0-or-later
 * Claims about schemes: the claim, what was measured, the verdict. */
#include "html.h"
#include "page_part.h"
#include "value.h"

static void claim_table(struct buffer *to, const json_t *claim)
{
    const json_t *row;
    size_t i;
    buffer_add(to, "<h3>");
    html_words(to, value_text(claim, "name"));
    buffer_add(to, ": ");
    buffer_escape(to, value_text(claim, "verdict"));
    buffer_add(to, "</h3>\n<p>");
    buffer_escape(to, value_text(claim, "claim"));
    buffer_add(to, " Errors of the figure, relative where its exact value is not 0:</p>\n");
    html_table(to, "runs", "both with|figure|#without|#with|verdict|see it again");
    buffer_add(to, "<tr><td></td><td></td><td class=\"n\"><code>");
    buffer_escape(to, value_text(claim, "without"));
    buffer_add(to, "</code></td><td class=\"n\"><code>");
    buffer_escape(to, value_text(claim, "with"));
    buffer_add(to, "</code></td><td></td><td></td></tr>\n");
    json_array_foreach(json_object_get(claim, "rows"), i, row)
    {
        buffer_add(to, "<tr>");
        html_cell_code(to, value_text(row, "label"));
        html_cell(to, value_text(row, "figure"));
        html_cell_number(to, value_member(row, "without"));
        html_cell_number(to, value_member(row, "with"));
        html_cell(to, value_text(row, "verdict"));
        html_cell_code(to, value_text(row, "reproduce"));
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
}

void page_claims(struct page_writer *writer, const json_t *claims)
{
    struct buffer *to = &writer->to;
    const json_t *claim;
    size_t i;
    buffer_add(to, "<section id=\"claims\"><h2>Claims, measured</h2>\n<p>Two schemes that differ "
                   "in one key on the same problem. A claim holds in a row if it makes the error "
                   "smaller by a factor of 1.25 at least. By day runs are small; what holds at "
                   "real sizes is in the report of the night.</p>\n");
    json_array_foreach(claims, i, claim) claim_table(to, claim);
    buffer_add(to, "</section>\n");
}
