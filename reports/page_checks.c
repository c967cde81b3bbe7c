/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks: a table per group with one line per check (the figure nearest to its bound) and all
 * figures of failed checks; and the detection power: which deliberate faults each check detects. */
#include <math.h>
#include <string.h>

#include "finding.h"
#include "html.h"
#include "page_part.h"
#include "value.h"

/* Figures [first, end) of a check. */
struct span {
    size_t first, end, failed, skipped, worst;
};

static double used(const json_t *figure)
{
    return finding_ratio(value_member(figure, "value"), value_member(figure, "bound"));
}

static struct span next_check(const json_t *figures, size_t first)
{
    struct span span = {.first = first, .end = first, .worst = first};
    const json_t *leader = json_array_get(figures, first), *figure;
    double most = -(double)INFINITY;
    for (; (figure = json_array_get(figures, span.end)); span.end++) {
        if (strcmp(value_text(figure, "group"), value_text(leader, "group")) ||
            strcmp(value_text(figure, "name"), value_text(leader, "name")))
            break;
        const char *status = value_text(figure, "status");
        bool skipped = !strcmp(status, "skip");
        span.failed += !strcmp(status, "fail");
        span.skipped += skipped;
        if (!skipped && used(figure) > most) {
            most = used(figure);
            span.worst = span.end;
        }
    }
    return span;
}

static void bar(struct buffer *to, double part)
{
    enum { MOST = 1000 };
    buffer_add(to, "<td class=\"n\">");
    if (!isfinite(part))
        buffer_add(to, "—");
    else if (part > 0 && part < 0.01)
        buffer_add(to, "&lt; 1 %");
    else if (part < MOST)
        buffer_format(to, "%.0f %%", 100 * part);
    else
        buffer_format(to, "> %d times", MOST);
    buffer_format(to,
                  "<span class=\"margin\"><i class=\"%s\" style=\"width:%.0f%%\"></i></span></td>",
                  part <= 0.5 ? ""
                  : part <= 1 ? "close"
                              : "over",
                  fmin(100, 100 * part));
}

static void figure_cells(struct buffer *to, const json_t *figure)
{
    html_cell(to, value_text(figure, "subject"));
    html_cell_number(to, value_member(figure, "value"));
    html_cell_number(to, value_member(figure, "bound"));
    html_cell_number(to, value_member(figure, "floor"));
    bar(to, used(figure));
}

static void check_row(struct buffer *to, const json_t *figures, const struct span *span)
{
    const json_t *leader = json_array_get(figures, span->first);
    size_t all = span->end - span->first, judged = all - span->skipped;
    buffer_add(to, "<tr><td>");
    html_status(to, span->failed ? "fail" : judged ? "pass" : "skip");
    html_format(to,
                " <code>%s</code><br/><span class=\"note\">%s</span></td>"
                "<td class=\"n\">%zu of %zu</td>",
                value_text(leader, "name"), value_text(leader, "property"), judged - span->failed,
                judged);
    if (judged)
        figure_cells(to, json_array_get(figures, span->worst));
    else
        buffer_add(to, "<td>not measured here</td><td></td><td></td><td></td><td></td>");
    buffer_add(to, "</tr>\n");
}

static void failing_figures(struct buffer *to, const json_t *figures, const struct span *span)
{
    enum { SHOWN = 20 };
    size_t shown = 0;
    for (size_t i = span->first; i < span->end && shown < SHOWN; i++) {
        const json_t *figure = json_array_get(figures, i);
        if (strcmp(value_text(figure, "status"), "fail") || i == span->worst) continue;
        buffer_add(to, "<tr><td class=\"note\">… and</td><td></td>");
        figure_cells(to, figure);
        buffer_add(to, "</tr>\n");
        shown++;
    }
    if (span->failed > shown + 1)
        buffer_format(
            to, "<tr><td colspan=\"7\" class=\"note\">… and %zu more failing figures</td></tr>\n",
            span->failed - shown - 1);
}

/* Writes the command that computes checks again; more: its last word. */
static void again(struct buffer *to, const json_t *verify, const char *more)
{
    struct buffer command = {0};
    buffer_format(&command, "%s %s", value_text_or(verify, "reproduce", "sphproof verify"), more);
    html_command(to, "see it again:", buffer_text(&command, to));
    buffer_free(&command);
}

void page_checks(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *verify = json_object_get(results, "verify");
    const json_t *figures = json_object_get(verify, "checks");
    if (!json_array_size(figures)) return;
    buffer_add(to, "<section id=\"checks\"><h2>Checks</h2>\n<p>One line a check: how many figures "
                   "hold, and of these the one nearest to its bound. The floor is the noise below "
                   "which the figure means nothing.</p>\n");
    const json_t *leader;
    for (size_t i = 0; (leader = json_array_get(figures, i));) {
        const char *group = value_text(leader, "group");
        html_format(to, "<h3>%-s</h3>\n", group);
        html_table(to, "checks", "check|#hold|nearest to its bound|#value|#bound|#floor|#of bound");
        for (; leader && !strcmp(value_text(leader, "group"), group);
             leader = json_array_get(figures, i)) {
            const struct span span = next_check(figures, i);
            check_row(to, figures, &span);
            if (span.failed > 1) failing_figures(to, figures, &span);
            i = span.end;
        }
        html_table_end(to);
        again(to, verify, group);
    }
    buffer_add(to, "</section>\n");
}

/* ---- detection power ---- */

void page_detection(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *verify = json_object_get(results, "verify");
    const json_t *mutants = json_object_get(verify, "mutants"), *entry;
    size_t n = json_array_size(mutants), caught = 0, i;
    buffer_add(to, "<section id=\"detection\"><h2>Detection power</h2>\n");
    if (!n) {
        buffer_add(to, "<p>Not measured in this report.</p>");
        html_command(to, "measure it:", "sphproof verify --mutants");
        buffer_add(to, "</section>\n");
        return;
    }
    json_array_foreach(mutants, i, entry)
        caught += json_is_true(json_object_get(entry, "detected"));
    buffer_format(
        to,
        "<p>A check is worth what it rejects. %.0f deliberate faults, each put before "
        "every check that must notice it: %zu trials, %zu caught; %.0f of the faults were "
        "caught in all of theirs.</p>\n<details%s><summary>Every fault, and the figure "
        "that gave it away</summary>\n",
        value_inner(verify, "summary", "mutants"), n, caught,
        value_inner(verify, "summary", "detected"), caught < n ? " open=\"open\"" : "");
    html_table(to, "mutants", "fault|check|#value|#bound|caught");
    for (int round = 0; round < 2; round++) { /* undetected faults first */
        json_array_foreach(mutants, i, entry) {
            bool detected = json_is_true(json_object_get(entry, "detected"));
            if (detected != (round == 1)) continue;
            const char *fault = value_text(entry, "fault");
            html_format(to, "<tr><td>%-s", value_text(entry, "mutant"));
            if (*fault) html_format(to, "<br/><span class=\"note\">%s</span>", fault);
            html_format(
                to,
                "</td><td><code>%s</code></td><td class=\"n\">%f</td><td class=\"n\">%f</td>"
                "<td><b class=\"%s\">%s</b></td></tr>\n",
                value_text(entry, "check"), value_member(entry, "value"),
                value_member(entry, "bound"), detected ? "pass" : "fail",
                detected ? "caught" : "missed");
        }
    }
    html_table_end(to);
    buffer_add(to, "</details>");
    again(to, verify, "--mutants");
    buffer_add(to, "</section>\n");
}
