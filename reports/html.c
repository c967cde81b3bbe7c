/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "html.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "value.h"

void html_number(struct buffer *to, double value)
{
    if (isnan(value)) {
        buffer_add(to, "nan");
    } else if (isinf(value)) {
        buffer_add(to, signbit(value) ? "−∞" : "∞");
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

void html_format(struct buffer *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    while (*format) {
        const size_t plain = strcspn(format, "%");
        buffer_add_bytes(to, format, plain);
        format += plain;
        if (!*format) break;
        char one[16];
        const size_t end = 1 + strcspn(format + 1, "%sudf");
        snprintf(one, sizeof one, "%.*s", (int)end + 1, format);
        if (format[end] == '%')
            buffer_add(to, "%");
        else if (format[end] == 's')
            (end == 1 ? buffer_escape : html_words)(to, va_arg(arguments, const char *));
        else if (format[end] == 'u')
            buffer_format(to, one, va_arg(arguments, size_t));
        else if (format[end] == 'd')
            buffer_format(to, one, va_arg(arguments, int));
        else if (end == 1)
            html_number(to, va_arg(arguments, double));
        else
            buffer_format(to, one, va_arg(arguments, double));
        format += end + 1;
    }
    va_end(arguments);
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
    html_format(to, "<td>%s</td>", string);
}

void html_cell_number(struct buffer *to, double value)
{
    html_format(to, "<td class=\"n\">%f</td>", value);
}

void html_digits(struct buffer *to, double value)
{
    if (isfinite(value))
        buffer_format(to, "%.8g", value);
    else
        html_number(to, value);
}

const json_t *html_member(const json_t *of, const char *path)
{
    char name[64];
    while (path && *path && of) {
        const size_t length = strcspn(path, "/");
        snprintf(name, sizeof name, "%.*s", (int)length, path);
        of = json_is_array(of) ? json_array_get(of, (size_t)atoi(name)) : json_object_get(of, name);
        path += length + (path[length] == '/');
    }
    return of;
}

/* True if an optional column is omitted; first: the first entry of the table. */
static bool left_out(const struct html_column *column, const json_t *first)
{
    return column->optional && !isfinite(value_real(html_member(first, column->member)));
}

static void heads(struct buffer *to, const char *class, const struct html_column *columns,
                  const json_t *first)
{
    struct buffer names = {0};
    for (const struct html_column *column = columns; column->head; column++)
        if (!left_out(column, first))
            buffer_format(&names, "%s%s", column == columns ? "" : "|", column->head);
    html_table(to, class, buffer_text(&names, to));
    buffer_free(&names);
}

static void show(struct buffer *to, const struct html_column *column, const json_t *value)
{
    const double number = value_real(value);
    const char *string = json_string_value(value), *text = string ? string : "";
    if (column->otherwise &&
        (!value || json_is_null(value) || (column->finite && !isfinite(number))))
        buffer_add(to, column->otherwise);
    else if (column->cell)
        column->cell(to, value);
    else if (column->kind == CELL_TEXT)
        buffer_escape(to, text);
    else if (column->kind == CELL_WORDS)
        html_words(to, text);
    else if (column->kind == CELL_STATUS)
        html_status(to, text);
    else if (column->kind == CELL_CODE)
        html_format(to, "<code>%s</code>", text);
    else if (column->format)
        buffer_format(to, column->format, number);
    else
        (column->kind == CELL_DIGITS ? html_digits : html_number)(to, number);
}

static void row(struct buffer *to, const struct html_column *columns, const json_t *entry,
                const json_t *around, const json_t *first)
{
    buffer_add(to, "<tr>");
    for (const struct html_column *column = columns; column->head; column++) {
        const bool outside = column->member && column->member[0] == '^';
        if (left_out(column, first)) continue;
        buffer_add(to, column->head[0] == '#' ? "<td class=\"n\">" : "<td>");
        show(to, column,
             outside ? html_member(around, column->member + 1)
                     : html_member(entry, column->member));
        buffer_add(to, "</td>");
    }
    buffer_add(to, "</tr>\n");
}

void html_heads(struct buffer *to, const char *class, const struct html_column *columns)
{
    heads(to, class, columns, NULL);
}

void html_row(struct buffer *to, const struct html_column *columns, const json_t *entry)
{
    row(to, columns, entry, NULL, NULL);
}

void html_list(struct buffer *to, const char *class, const struct html_column *columns,
               const json_t *list, bool (*shown)(const json_t *entry))
{
    const json_t *entry;
    size_t i;
    html_heads(to, class, columns);
    json_array_foreach(list, i, entry)
        if (!shown || shown(entry)) html_row(to, columns, entry);
    html_table_end(to);
}

void html_lists(struct buffer *to, const char *class, const struct html_column *columns,
                const json_t *const *documents, size_t count, const char *list)
{
    const json_t *entry, *first = list ? NULL : documents[0];
    size_t i;
    heads(to, class, columns, first);
    for (size_t k = 0; k < count; k++)
        if (list)
            json_array_foreach(json_object_get(documents[k], list), i, entry)
                row(to, columns, entry, documents[k], first);
        else
            row(to, columns, documents[k], NULL, first);
    html_table_end(to);
}

void html_command(struct buffer *to, const char *what, const char *command)
{
    if (!*command) return;
    html_format(to, "<p class=\"command\"><span>%s</span> <code>%s</code></p>\n", what, command);
}

void html_status(struct buffer *to, const char *status)
{
    static const char *const classes[][2] = {
        {"pass", "pass"},  {"ok", "pass"},    {"skip", "skip"},        {"none", "skip"},
        {"known", "open"}, {"smoke", "open"}, {"undetermined", "open"}};
    const char *class = "fail";
    for (size_t k = 0; k < sizeof classes / sizeof *classes; k++)
        if (!strcmp(status, classes[k][0])) class = classes[k][1];
    html_format(to, "<b class=\"%s\">%-s</b>", class, status);
}

void html_order(struct buffer *to, const json_t *order)
{
    buffer_format(to, "%.2f ± %.2f", value_member(order, "order"),
                  (value_member(order, "high") - value_member(order, "low")) / 2);
}

void html_order_cell(struct buffer *to, const json_t *order)
{
    buffer_add(to, "<td class=\"n\">");
    if (order)
        html_order(to, order);
    else
        buffer_add(to, "—");
    buffer_add(to, "</td>");
}

void html_words(struct buffer *to, const char *name)
{
    char copy[2] = "";
    for (; *name; name++) {
        copy[0] = *name == '_' ? ' ' : *name;
        buffer_escape(to, copy);
    }
}
