/* SPDX-License-Identifier: GPL-3.0-or-later
 * Elements of HTML (written as XML, so that it can be validated) for the pages. Internal to
 * pages. */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "buffer.h"

/* Writes three significant digits in the usual form: 0.00461 is 4.61e-3, 12 is 12. */
void html_number(struct buffer *to, double value);
/* Writes eight digits, for values that are nearly equal. */
void html_digits(struct buffer *to, double value);

/* As printf with %d, %zu and %.1f, but %s is escaped, %-s written by html_words and %f by
 * html_number. */
void html_format(struct buffer *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Begins <table class="..."> in a box that scrolls horizontally on a narrow screen, with a head row
 * from columns separated by '|' (a leading '#' marks a numeric column). */
void html_table(struct buffer *to, const char *class, const char *columns);
void html_table_end(struct buffer *to);
void html_cell(struct buffer *to, const char *string);
void html_cell_number(struct buffer *to, double value);

enum html_kind { CELL_NUMBER, CELL_TEXT, CELL_WORDS, CELL_CODE, CELL_DIGITS, CELL_STATUS };

/* A column of a table whose rows are entries of the results. */
struct html_column {
    const char *head; /* as for html_table; NULL ends a list of columns */
    /* Path of the value in the entry: "conservation/mass", "skips/0/bound"; with '^' before it, in
     * the document that contains the entry; NULL: the entry itself, which `cell` writes. */
    const char *member;
    enum html_kind kind;
    const char *format;    /* for a number */
    const char *otherwise; /* shown for null and for a missing value */
    bool finite;           /* also shown for a value that is not finite */
    void (*cell)(struct buffer *to, const json_t *value); /* writes the contents of the cell */
    bool optional; /* omitted if the first entry of the table has no finite number here */
};

/* COLUMN(head, member), COLUMN(head, member, .kind = CELL_TEXT) ... */
#define COLUMN(head_, ...)                                                                         \
    {                                                                                              \
        .head = head_, .member = __VA_ARGS__                                                       \
    }

/* The member "a/b/0" of an object (0: of a list); the object itself for NULL. NULL: there is none.
 */
const json_t *html_member(const json_t *of, const char *path);

/* Write the head of a table, to be ended by html_table_end, and a row; without optional columns. */
void html_heads(struct buffer *to, const char *class, const struct html_column *columns);
void html_row(struct buffer *to, const struct html_column *columns, const json_t *entry);
/* Write a table of the entries for which `shown` is true (NULL: all): the entries of a list; the
 * entries of the list of this name in each document; or, with list NULL, the documents. */
void html_list(struct buffer *to, const char *class, const struct html_column *columns,
               const json_t *list, bool (*shown)(const json_t *entry));
void html_lists(struct buffer *to, const char *class, const struct html_column *columns,
                const json_t *const *documents, size_t count, const char *list);

/* Writes <p class="command"><code>$ command</code></p> after a description. */
void html_command(struct buffer *to, const char *what, const char *command);

/* Writes a status as a coloured word: passed, not judged, open (known, smoke, undetermined), or
 * else failed. */
void html_status(struct buffer *to, const char *status);

/* Writes an order with half of its interval, "1.97 ± 0.03"; the second function writes a cell, with
 * a dash for NULL. */
void html_order(struct buffer *to, const json_t *order);
void html_order_cell(struct buffer *to, const json_t *order);

/* Writes a name from the results as words: "internal_energy" is "internal energy". */
void html_words(struct buffer *to, const char *name);
