/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "buffer.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ensures capacity for n more bytes and the NUL. */
static bool reserve(struct buffer *to, size_t n)
{
    if (to->failed) return false;
    if (to->size + n + 1 <= to->capacity) return true;
    size_t capacity = to->capacity ? to->capacity : 256;
    while (capacity < to->size + n + 1) capacity *= 2;
    char *data = realloc(to->data, capacity);
    if (!data) {
        to->failed = true;
        return false;
    }
    to->data = data;
    to->capacity = capacity;
    return true;
}

void buffer_add_bytes(struct buffer *to, const char *bytes, size_t n)
{
    if (!reserve(to, n)) return;
    memcpy(to->data + to->size, bytes, n);
    to->size += n;
    to->data[to->size] = '\0';
}

void buffer_add(struct buffer *to, const char *string)
{
    buffer_add_bytes(to, string, strlen(string));
}

void buffer_format(struct buffer *to, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int n = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (n < 0 || !reserve(to, (size_t)n)) {
        to->failed = true;
        return;
    }
    va_start(arguments, format);
    vsnprintf(to->data + to->size, (size_t)n + 1, format, arguments);
    va_end(arguments);
    to->size += (size_t)n;
}

void buffer_escape(struct buffer *to, const char *string)
{
    for (const char *c = string; *c; c++) {
        unsigned char byte = (unsigned char)*c;
        if (byte == '&')
            buffer_add(to, "&amp;");
        else if (byte == '<')
            buffer_add(to, "&lt;");
        else if (byte == '>')
            buffer_add(to, "&gt;");
        else if (byte == '"')
            buffer_add(to, "&quot;");
        else if (byte == '\'')
            buffer_add(to, "&#39;");
        else if (byte < 0x20 && byte != '\n' && byte != '\t')
            buffer_add(to, "\xef\xbf\xbd");
        else
            buffer_add_bytes(to, c, 1);
    }
}

const char *buffer_text(const struct buffer *part, struct buffer *to)
{
    to->failed |= part->failed;
    return part->data && !part->failed ? part->data : "";
}

char *buffer_take(struct buffer *to)
{
    if (!to->data && !to->failed) buffer_add(to, "");
    char *data = to->data;
    if (to->failed) {
        free(data);
        data = NULL;
    }
    *to = (struct buffer){0};
    return data;
}

void buffer_free(struct buffer *to)
{
    free(to->data);
    *to = (struct buffer){0};
}
