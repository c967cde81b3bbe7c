/* SPDX-License-Identifier: GPL-3.0-or-later
 * All cases in one table: what a reader wants to know before anything else. */
#include <math.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "page_study.h"
#include "value.h"

/* The document in a list for a case and a scheme, or NULL. */
static const json_t *find(const json_t *list, const char *case_name, const char *label)
{
    size_t i;
    const json_t *entry;
    json_array_foreach(list, i, entry)
    {
        if (!strcmp(value_text(entry, "case"), case_name) &&
            !strcmp(value_text(entry, "label"), label))
            return entry;
    }
    return NULL;
}

/* Labels of the schemes, in the order in which they appear. */
static size_t schemes(const json_t *studies, const char **labels)
{
    size_t n = 0, i;
    const json_t *entry;
    json_array_foreach(studies, i, entry)
    {
        const char *label = value_text(entry, "label");
        size_t k = 0;
        while (k < n && strcmp(labels[k], label)) k++;
        if (k == n && n < PAGE_SCHEMES) labels[n++] = label;
    }
    return n;
}

static const char *status_of(const json_t *study, const json_t *run)
{
    const char *judged = value_text(study, "status"), *ran = value_text(run, "status");
    if (!strcmp(judged, "fail") || !strcmp(judged, "broke_down")) return judged;
    return !strcmp(ran, "broke_down") ? ran : "ok";
}

static void row(struct buffer *to, const json_t *results, const json_t *first,
                const char *const *labels, size_t count)
{
    const json_t *studies = json_object_get(results, "studies");
    const json_t *runs = json_object_get(results, "runs");
    const char *name = value_text(first, "case");
    const json_t *levels = json_object_get(first, "levels");
    const json_t *run = find(runs, name, labels[0]);
    buffer_add(to, "<tr><td><a href=\"#case-");
    buffer_escape(to, name);
    buffer_add(to, "\">");
    html_words(to, name);
    buffer_add(to, "</a></td>");
    html_cell_number(to, value_member(json_array_get(levels, json_array_size(levels) - 1), "n"));
    const char *status = "ok";
    for (size_t k = 0; k < count; k++) {
        const json_t *study = find(studies, name, labels[k]);
        levels = json_object_get(study, "levels");
        const json_t *finest = json_array_get(levels, json_array_size(levels) - 1);
        html_cell_number(to, value_inner(json_object_get(finest, "errors"), "density", "l1_cut"));
        const char *now = status_of(study, find(runs, name, labels[k]));
        if (strcmp(now, "ok")) status = now;
    }
    const json_t *order = page_study_order(first, "density", "l1_cut");
    buffer_format(to, "<td class=\"n\">%.2f ± %.2f</td>", value_member(order, "order"),
                  (value_member(order, "high") - value_member(order, "low")) / 2);
    html_cell_number(to, value_inner(run, "conservation", "momentum"));
    html_cell_number(to, value_inner(run, "conservation", "energy"));
    buffer_add(to, "<td>");
    html_status(to, status);
    buffer_add(to, "</td></tr>\n");
}

void page_overview(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to, columns = {0};
    const json_t *studies = json_object_get(results, "studies"), *entry;
    const char *labels[PAGE_SCHEMES];
    size_t count = schemes(studies, labels), i;
    if (!count) return;
    buffer_add(&columns, "case|#n");
    for (size_t k = 0; k < count; k++) {
        buffer_add(&columns, "|#L1 density, ");
        buffer_escape(&columns, labels[k]);
    }
    buffer_add(&columns, "|#order, ");
    buffer_escape(&columns, labels[0]);
    buffer_add(&columns, "|#momentum error|#energy error|");
    buffer_add(to, "<section id=\"overview\"><h2>All cases at a glance</h2>\n");
    if (columns.data) html_table(to, "overview", columns.data);
    buffer_free(&columns);
    json_array_foreach(studies, i, entry)
    {
        if (!strcmp(value_text(entry, "label"), labels[0])) row(to, results, entry, labels, count);
    }
    html_table_end(to);
    buffer_add(to, "</section>\n");
}
