/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "html.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void html_number(struct buffer *to, double value)
{
    if (isnan(value)) {
        buffer_add(to, "nan");
    } else if (isinf(value)) {
        buffer_add(to, value > 0 ? "∞" : "−∞");
    } else if (value == 0) {
        buffer_add(to, "0");
    } else if (fabs(value) >= 0.01 && fabs(value) < 1e5) {
        if (value == floor(value))
            buffer_format(to, "%.0f", value);
        else
            buffer_format(to, "%.4g", value);
    } else {
        char digits[64];
        snprintf(digits, sizeof digits, "%.2e", value);
        char *e = strchr(digits, 'e');
        buffer_add_bytes(to, digits, (size_t)(e - digits));
        buffer_format(to, "e%d", atoi(e + 1));
    }
}

void html_table(struct buffer *to, const char *class, const char *columns)
{
    buffer_format(to, "<div class=\"scroll\"><table class=\"%s\"><thead><tr>", class);
    for (bool more = true; more;) {
        size_t n = strcspn(columns, "|");
        bool number = *columns == '#';
        buffer_add(to, number ? "<th class=\"n\">" : "<th>");
        buffer_add_bytes(to, columns + number, n - number);
        buffer_add(to, "</th>");
        more = columns[n] == '|';
        columns += n + more;
    }
    buffer_add(to, "</tr></thead><tbody>\n");
}

void html_table_end(struct buffer *to)
{
    buffer_add(to, "</tbody></table></div>\n");
}

void html_cell(struct buffer *to, const char *string)
{
    buffer_add(to, "<td>");
    buffer_escape(to, string);
    buffer_add(to, "</td>");
}

void html_cell_number(struct buffer *to, double value)
{
    buffer_add(to, "<td class=\"n\">");
    html_number(to, value);
    buffer_add(to, "</td>");
}

void html_cell_digits(struct buffer *to, double value)
{
    if (isfinite(value))
        buffer_format(to, "<td class=\"n\">%.8g</td>", value);
    else
        html_cell_number(to, value);
}

void html_cell_code(struct buffer *to, const char *string)
{
    buffer_add(to, "<td><code>");
    buffer_escape(to, string);
    buffer_add(to, "</code></td>");
}

void html_command(struct buffer *to, const char *what, const char *command)
{
    if (!*command) return;
    buffer_add(to, "<p class=\"command\"><span>");
    buffer_escape(to, what);
    buffer_add(to, "</span> <code>");
    buffer_escape(to, command);
    buffer_add(to, "</code></p>\n");
}

void html_status(struct buffer *to, const char *status)
{
    static const char *const classes[][2] = {
        {"pass", "pass"},  {"ok", "pass"},    {"skip", "skip"},        {"none", "skip"},
        {"known", "open"}, {"smoke", "open"}, {"undetermined", "open"}};
    const char *class = "fail";
    for (size_t k = 0; k < sizeof classes / sizeof *classes; k++)
        if (!strcmp(status, classes[k][0])) class = classes[k][1];
    buffer_format(to, "<b class=\"%s\">", class);
    html_words(to, status);
    buffer_add(to, "</b>");
}

void html_words(struct buffer *to, const char *name)
{
    char copy[2] = "";
    for (; *name; name++) {
        copy[0] = *name == '_' ? ' ' : *name;
        buffer_escape(to, copy);
    }
}
