/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the world did to the program, and what came of it: one line a fault. */
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

/* An exit status, or the signal that ended it where that is how it must end. */
static void ended(struct buffer *to, const json_t *fault)
{
    const json_t *number = json_object_get(fault, "exit");
    const int value = (int)json_number_value(number);
    buffer_add(to, "<td>");
    if (json_is_number(number))
        buffer_format(to, value < 0 ? "signal %d" : "exit status %d", abs(value));
    buffer_add(to, "</td>");
}

static void row(struct buffer *to, const json_t *fault)
{
    const char *detail = value_text(fault, "detail");
    buffer_add(to, "<tr>");
    html_cell(to, value_text(fault, "fault"));
    buffer_add(to, "<td>");
    html_status(to, value_text(fault, "status"));
    buffer_add(to, "</td>");
    ended(to, fault);
    buffer_add(to, "<td class=\"note\">");
    if (*detail) {
        buffer_add(to, "<b class=\"fail\">");
        buffer_escape(to, detail);
        buffer_add(to, "</b><br/>");
    }
    buffer_escape(to, value_text(fault, "message"));
    buffer_add(to, "</td></tr>\n");
}

void page_faults(struct page_writer *writer, const json_t *results)
{
    struct buffer *to = &writer->to;
    const json_t *faults = json_object_get(results, "faults"), *entry;
    const json_t *list = json_object_get(faults, "faults");
    const char *git = value_text(faults, "git"), *command = "";
    size_t i;
    buffer_add(to, "<section id=\"faults\"><h2>Faults of the world around it</h2>\n"
                   "<p>Full disks, missing rights, broken tools, odd paths and locales, closed "
                   "streams, no memory, and kill -9: each time the exit status and the message "
                   "must be right, and nothing may be lost or left half-written. Tried ");
    buffer_escape(to, value_text(faults, "date"));
    if (strcmp(git, value_text(results, "git"))) {
        buffer_add(to, ", with another build (git ");
        buffer_escape(to, git);
        buffer_add(to, ")");
    }
    buffer_add(to, ".</p>\n");
    for (int round = 0; round < 2; round++) { /* first what went wrong */
        bool open = false;
        json_array_foreach(list, i, entry) {
            if (!strcmp(value_text(entry, "status"), "fail") != (round == 0)) continue;
            if (!open) html_table(to, "faults", "fault|answer|ended with|message");
            open = true;
            row(to, entry);
        }
        if (open) html_table_end(to);
    }
    buffer_add(to, "<details><summary>Try them again, part by part</summary>\n");
    json_array_foreach(list, i, entry) {
        if (!strcmp(command, value_text(entry, "command"))) continue;
        command = value_text(entry, "command");
        html_command(to, value_text(entry, "part"), command);
    }
    buffer_add(to, "</details></section>\n");
}
