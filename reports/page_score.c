/* SPDX-License-Identifier: GPL-3.0-or-later
 * The mutation score: of faults that were generated, how many the tests noticed, file by file, and
 * those that no test noticed. */
#include "html.h"
#include "page_part.h"
#include "value.h"

static double killable(const json_t *entry)
{
    return value_member(entry, "mutants") - value_member(entry, "listed");
}

static void file_row(struct buffer *to, const json_t *file)
{
    buffer_add(to, "<tr>");
    html_cell_code(to, value_text(file, "file"));
    html_cell_number(to, value_member(file, "mutants"));
    html_cell_number(to, value_member(file, "killed"));
    html_cell_number(to, value_member(file, "listed"));
    html_cell_number(to, value_member(file, "survived"));
    html_cell_digits(to, 100 * value_member(file, "killed") / killable(file));
    buffer_add(to, "</tr>\n");
}

void page_score(struct page_writer *writer, const json_t *score)
{
    struct buffer *to = &writer->to;
    const json_t *entry;
    size_t i;
    buffer_add(to,
               "<section id=\"score\"><h2>Mutation score</h2>\n<p>One-line faults, generated at "
               "every operator, constant, statement and returned status, that the tests must "
               "notice: ");
    buffer_format(to, "%.0f of %.0f were tried, ", value_member(score, "tried"),
                  value_member(score, "generated"));
    html_number(to, 100 * value_member(score, "score"));
    buffer_format(to, " %% of those noticed that a result can show, in %.0f s.</p>\n",
                  value_member(score, "seconds"));
    html_table(to, "score", "file|mutants|noticed|listed: no result differs|survived|%");
    json_array_foreach(json_object_get(score, "files"), i, entry) file_row(to, entry);
    html_table_end(to);
    buffer_add(to, "<details><summary>Survivors</summary>\n");
    html_table(to, "score", "file|line|change|");
    json_array_foreach(json_object_get(score, "survivors"), i, entry) {
        buffer_add(to, "<tr>");
        html_cell_code(to, value_text(entry, "file"));
        html_cell_number(to, value_member(entry, "line"));
        html_cell_code(to, value_text(entry, "change"));
        html_cell(to, value_text(entry, "why"));
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
    buffer_add(to, "</details></section>\n");
}
