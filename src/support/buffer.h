/* SPDX-License-Identifier: GPL-3.0-or-later
 * A string that grows. Running out of memory is remembered, not reported at each step: the caller
 * checks `failed` (or buffer_take's NULL) once at the end. */
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

/* Escaped for HTML and XML: content and attribute values; control characters, which XML forbids,
 * become U+FFFD. */
void buffer_escape(struct buffer *to, const char *string);

/* The string, which the caller frees; the buffer is empty again. NULL: out of memory. */
char *buffer_take(struct buffer *to);
void buffer_free(struct buffer *to);
