/* SPDX-License-Identifier: GPL-3.0-or-later
 * A growing string. Running out of memory is recorded, not reported at each call: the caller checks
 * `failed` (or the NULL of buffer_take) once at the end. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

struct buffer {
    char *data;  /* NUL-terminated, or NULL while empty */
    size_t size; /* bytes without the NUL */
    size_t capacity;
    bool failed;
};

void buffer_add(struct buffer *to, const char *string);
void buffer_add_bytes(struct buffer *to, const char *bytes, size_t n);
void buffer_format(struct buffer *to, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Appends a string escaped for HTML and XML, as content or attribute value; control characters,
 * which XML forbids, become U+FFFD. */
void buffer_escape(struct buffer *to, const char *string);

/* The string so far; where memory has ended "", and `to`, which it is a part of, fails too. */
const char *buffer_text(const struct buffer *part, struct buffer *to);

/* Returns the string, which the caller frees, and empties the buffer. NULL: no memory. */
char *buffer_take(struct buffer *to);
void buffer_free(struct buffer *to);
