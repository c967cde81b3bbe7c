/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faults of the environment and the reactions of the program, one line per fault. */
#include <stdlib.h>
#include <string.h>

#include "html.h"
#include "page_part.h"
#include "value.h"

static void row(struct buffer *to, const json_t *fault)
{
    const char *detail = value_text(fault, "detail");
    const json_t *number = json_object_get(fault, "exit");
    const int value = (int)json_number_value(number); /* < 0: the signal that ended the process */
    html_format(to, "<tr><td>%s</td><td>", value_text(fault, "fault"));
    html_status(to, value_text(fault, "status"));
    buffer_add(to, "</td><td>");
    if (json_is_number(number))
        buffer_format(to, value < 0 ? "signal %d" : "exit status %d", abs(value));
    buffer_add(to, "</td><td class=\"note\">");
    if (*detail) html_format(to, "<b class=\"fail\">%s</b><br/>", detail);
    html_format(to, "%s</td></tr>\n", value_text(fault, "message"));
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
                   "must be right, and nothing may be lost or left half-written. ");
    html_format(to, "Tried %s", value_text(faults, "date"));
    if (strcmp(git, value_text(results, "git")))
        html_format(to, ", with another build (git %s)", git);
    buffer_add(to, ".</p>\n");
    for (int round = 0; round < 2; round++) { /* failures first */
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
