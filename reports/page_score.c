/* SPDX-License-Identifier: GPL-3.0-or-later
 * The mutation score: the share of generated faults that the tests detected, by file, and the
 * undetected faults. */
#include "html.h"
#include "page_part.h"
#include "value.h"

static void killed(struct buffer *to, const json_t *file)
{
    const double counted = value_member(file, "mutants") - value_member(file, "listed");
    if (counted > 0)
        html_digits(to, 100 * value_member(file, "killed") / counted);
    else
        buffer_add(to, "—"); /* all are listed */
}

static const struct html_column files[] = {COLUMN("file", "file", .kind = CELL_CODE),
                                           COLUMN("#mutants", "mutants"),
                                           COLUMN("#noticed", "killed"),
                                           COLUMN("#listed: no result differs", "listed"),
                                           COLUMN("#survived", "survived"),
                                           COLUMN("#%", NULL, .cell = killed),
                                           {0}},
                                survivors[] = {COLUMN("file", "file", .kind = CELL_CODE),
                                               COLUMN("#line", "line"),
                                               COLUMN("change", "change", .kind = CELL_CODE),
                                               COLUMN("", "why", .kind = CELL_TEXT),
                                               {0}};

void page_score(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *score = json_object_get(results, "score");
    html_format(to,
                "<section id=\"score\"><h2>Mutation score</h2>\n<p>One-line faults, generated at "
                "every operator, constant, statement and returned status, that the tests must "
                "notice: %.0f of %.0f were tried, %f %% of those noticed that a result can show, "
                "in %.0f s.</p>\n",
                value_member(score, "tried"), value_member(score, "generated"),
                100 * value_member(score, "score"), value_member(score, "seconds"));
    html_list(to, "score", files, json_object_get(score, "files"), NULL);
    buffer_add(to, "<details><summary>Survivors</summary>\n");
    html_list(to, "score", survivors, json_object_get(score, "survivors"), NULL);
    buffer_add(to, "</details></section>\n");
}
