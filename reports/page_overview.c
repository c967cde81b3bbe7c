/* SPDX-License-Identifier: GPL-3.0-or-later
 * All cases in one table, as an overview. */
#include <math.h>
#include <string.h>

#include "case_state.h"
#include "html.h"
#include "page_part.h"
#include "value.h"

static bool is_cloud(const json_t *document)
{
    return value_member(document, "dimension") > 1;
}

static void case_cells(struct buffer *to, const char *name, double n)
{
    buffer_add(to, "<tr>");
    case_state_cell(to, name);
    html_cell_number(to, n);
}

static void end_row(struct buffer *to, const json_t *results, const char *name, const json_t *order,
                    const json_t *run)
{
    html_order_cell(to, order);
    html_cell_number(to, value_inner(run, "conservation", "momentum"));
    html_cell_number(to, value_inner(run, "conservation", "energy"));
    buffer_add(to, "<td>");
    html_status(to, case_state(results, name));
    buffer_add(to, "</td></tr>\n");
}

/* Writes the head of a table: a column for each label, then those of end_row. */
static void heads(struct buffer *to, const char *first, const char *each, const char *const *labels,
                  size_t count)
{
    struct buffer columns = {0};
    buffer_add(&columns, first);
    for (size_t k = 0; k < count; k++) html_format(&columns, "|#%s%s", each, labels[k]);
    html_format(&columns, "|#order, %s|#momentum error|#energy error|", labels[0]);
    html_table(to, "overview", buffer_text(&columns, to));
    buffer_free(&columns);
}

static void row(struct buffer *to, const json_t *results, const json_t *first,
                const char *const *labels, size_t count)
{
    const json_t *studies = json_object_get(results, "studies");
    const json_t *runs = json_object_get(results, "runs");
    const char *name = value_text(first, "case");
    const json_t *run = case_state_find(runs, name, labels[0]);
    case_cells(to, name, value_member(case_state_finest(first), "n"));
    for (size_t k = 0; k < count; k++) {
        const json_t *finest = case_state_finest(case_state_find(studies, name, labels[k]));
        html_cell_number(to, value_inner(json_object_get(finest, "errors"), "density", "l1"));
    }
    end_row(to, results, name, page_study_order(first, "density", "l1"), run);
}

/* ---- 2D and 3D: runs with the errors by which they are judged ---- */

static void cloud_row(struct buffer *to, const json_t *results, const json_t *run,
                      const char *const *labels, size_t count)
{
    const json_t *runs = json_object_get(results, "runs");
    const char *case_name = value_text(run, "case"), *what;
    const json_t *study =
        case_state_find(json_object_get(results, "studies"), case_name, labels[0]);
    case_state_error(run, &what);
    case_cells(to, case_name, value_member(run, "n"));
    html_format(to, "<td>%-s</td>", what);
    for (size_t k = 0; k < count; k++) {
        const json_t *one = case_state_find(runs, case_name, labels[k]);
        if (one)
            html_cell_number(to, case_state_error(one, &what));
        else
            buffer_add(to, "<td class=\"n\">—</td>");
    }
    end_row(to, results, case_name, page_study_main(study), run);
}

static void clouds(struct buffer *to, const json_t *results)
{
    const json_t *runs = json_object_get(results, "runs"), *entry;
    const char *labels[PAGE_SCHEMES];
    size_t count = case_state_labels(runs, 2, 3, labels), i;
    if (!count) return;
    buffer_add(to, "<h3>In 2D and 3D</h3>\n");
    heads(to, "case|#n|error of", "", labels, count);
    json_array_foreach(runs, i, entry) {
        if (is_cloud(entry) && !strcmp(value_text(entry, "label"), labels[0]))
            cloud_row(to, results, entry, labels, count);
    }
    html_table_end(to);
    buffer_add(to, "<p class=\"note\">L1 of what a case is about, or how far a scalar is from its "
                   "exact value. n is the number of all particles.</p>\n");
}

static void lines(struct buffer *to, const json_t *results)
{
    const json_t *studies = json_object_get(results, "studies"), *entry;
    const char *labels[PAGE_SCHEMES];
    size_t count = case_state_labels(studies, 1, 1, labels), i;
    if (!count) return;
    heads(to, "case|#n", "L1 density, ", labels, count);
    json_array_foreach(studies, i, entry) {
        if (!is_cloud(entry) && !strcmp(value_text(entry, "label"), labels[0]))
            row(to, results, entry, labels, count);
    }
    html_table_end(to);
}

void page_overview(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const char *labels[PAGE_SCHEMES];
    const bool both = case_state_labels(json_object_get(results, "studies"), 1, 1, labels) &&
                      case_state_labels(json_object_get(results, "runs"), 2, 3, labels);
    buffer_add(to, "<section id=\"overview\"><h2>All cases at a glance</h2>\n");
    if (both) buffer_add(to, "<h3>In 1D</h3>\n");
    lines(to, results);
    clouds(to, results);
    buffer_add(to, "</section>\n");
}
