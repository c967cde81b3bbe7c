/* SPDX-License-Identifier: GPL-3.0-or-later
 * Other codes: a matrix of cases and codes with errors, orders and gates, conservation, assumptions
 * about their files, and descriptions. */
#include <math.h>
#include <string.h>

#include "case_state.h"
#include "html.h"
#include "page_part.h"
#include "value.h"

static bool is_code(const json_t *document)
{
    return json_is_object(json_object_get(document, "code"));
}

bool page_of_codes(const json_t *results)
{
    return !strcmp(value_text(results, "mode"), "code");
}

/* The worst status of a document's gates; "none" if there is no gate. */
static const char *gate_of(const json_t *document, const char *list)
{
    static const char *const worse[] = {"fail", "undetermined", "known", "smoke", "pass"};
    for (size_t k = 0; k < sizeof worse / sizeof *worse; k++) {
        const json_t *gate;
        size_t i;
        json_array_foreach(json_object_get(document, list), i, gate)
            if (!strcmp(value_text(gate, "status"), worse[k])) return worse[k];
    }
    return "none";
}

static void again(struct buffer *to, const char *command)
{
    buffer_add(to, "<details><summary>command</summary>");
    html_command(to, "", command);
    buffer_add(to, "</details>");
}

/* Writes the error at the finest level, the order with its interval, the gate and the command. */
static void cell(struct buffer *to, const json_t *study, const json_t *run)
{
    const json_t *shown = study ? study : run, *order = study ? page_study_main(study) : NULL;
    const char *status = value_text(shown, "status"), *what;
    buffer_add(to, "<td>");
    if (!shown) {
        buffer_add(to, "—</td>");
        return;
    }
    if (!strcmp(status, "failed") || !strcmp(status, "broke_down")) {
        html_status(to, status);
        html_format(to, " %s", value_text(shown, "message"));
    } else if (order) {
        page_study_name(to, order);
        html_format(to, " %f at n&#160;=&#160;%.0f<br/>order %.2f [%.2f,&#160;%.2f]",
                    page_study_finest(study), value_member(case_state_finest(study), "n"),
                    value_member(order, "order"), value_member(order, "low"),
                    value_member(order, "high"));
    } else {
        const double error = case_state_error(run, &what);
        html_format(to, "%-s %f", what, error);
    }
    const char *gate = gate_of(shown, study ? "orders" : "gates");
    if (strcmp(gate, "none")) {
        buffer_add(to, " ");
        if (strcmp(gate, "smoke"))
            html_status(to, gate);
        else
            buffer_add(to, "<b class=\"open\">too coarse to judge</b>");
    }
    again(to, value_text(shown, "reproduce"));
    buffer_add(to, "</td>");
}

static void heads(struct buffer *to, const char *first, const char *const *labels, size_t count)
{
    struct buffer columns = {0};
    buffer_add(&columns, first);
    for (size_t k = 0; k < count; k++) html_format(&columns, "|%s", labels[k]);
    html_table(to, "overview", buffer_text(&columns, to));
    buffer_free(&columns);
}

/* True if this is the first run of its case. */
static bool begins_case(const json_t *runs, size_t i)
{
    const char *name = value_text(json_array_get(runs, i), "case");
    return case_state_find(runs, name, NULL) == json_array_get(runs, i);
}

static void matrix(struct buffer *to, const json_t *results, const char *const *labels,
                   size_t count)
{
    const json_t *runs = json_object_get(results, "runs"), *run;
    size_t i;
    heads(to, "case", labels, count);
    json_array_foreach(runs, i, run) {
        const char *name = value_text(run, "case");
        if (!begins_case(runs, i)) continue;
        buffer_add(to, "<tr>");
        case_state_cell(to, name);
        for (size_t k = 0; k < count; k++)
            cell(to, case_state_find(json_object_get(results, "studies"), name, labels[k]),
                 case_state_find(runs, name, labels[k]));
        buffer_add(to, "</tr>\n");
    }
    html_table_end(to);
    buffer_add(to, "<p class=\"note\">L1 of what a case is about at the finest level, its order "
                   "with the 95 % interval, and what the gates of the code file say. Our own "
                   "schemes run on the same ladder, without gates.</p>\n");
}

static bool is_sound(const json_t *run)
{
    return !strcmp(value_text(run, "status"), "ok");
}

static const struct html_column conserved[] = {
    COLUMN("case", "case", .kind = CELL_TEXT),
    COLUMN("code", "label", .kind = CELL_TEXT),
    COLUMN("#n", "n"),
    COLUMN("#mass", "conservation/mass", .otherwise = "—"),
    COLUMN("#momentum", "conservation/momentum", .otherwise = "—"),
    COLUMN("#angular momentum", "conservation/angular_momentum", .otherwise = "—"),
    COLUMN("#energy", "conservation/energy", .otherwise = "—"),
    COLUMN("#kinetic energy regained", "conservation/ke_rebound", .otherwise = "—"),
    COLUMN("#halves differ", "conservation/ke_asymmetry", .otherwise = "—"),
    COLUMN("#centre, spacings", "conservation/centre", .otherwise = "—"),
    {0}};

static const struct html_column assumed[] = {COLUMN("what", "what", .kind = CELL_TEXT),
                                             COLUMN("value", "value", .kind = CELL_TEXT),
                                             COLUMN("evidence", "evidence", .kind = CELL_TEXT),
                                             {0}};

static const struct html_column programs[] = {
    COLUMN("code", "code/title", .kind = CELL_TEXT),
    COLUMN("case", "case", .kind = CELL_TEXT),
    COLUMN("command", "code/command", .kind = CELL_CODE),
    COLUMN("SHA-256 of the program", "code/sha256", .kind = CELL_CODE),
    COLUMN("initial state", "code/ic", .kind = CELL_TEXT),
    {0}};

static void assumptions(struct buffer *to, const json_t *run)
{
    const json_t *list = json_object_get(json_object_get(run, "judged"), "assumptions");
    if (!json_array_size(list)) return;
    html_format(to, "<details><summary>What was assumed of %s, %s</summary>\n",
                value_text(run, "label"), value_text(run, "case"));
    html_list(to, "facts", assumed, list, NULL);
    buffer_add(to, "</details>\n");
}

void page_codes(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *runs = json_object_get(results, "runs"), *run;
    const char *labels[PAGE_SCHEMES];
    const size_t count = case_state_labels(runs, 1, 3, labels);
    size_t i;
    buffer_add(to, "<section id=\"overview\"><h2>All cases at a glance</h2>\n");
    matrix(to, results, labels, count);
    buffer_add(to, "<h3>Conservation</h3>\n");
    html_list(to, "runs", conserved, runs, is_sound);
    buffer_add(to, "<h3>The codes</h3>\n");
    html_list(to, "facts", programs, runs, is_code);
    json_array_foreach(runs, i, run) assumptions(to, run);
    buffer_add(to, "</section>\n");
}
