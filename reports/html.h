/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small parts of HTML (written as XML, so that it can be checked), for the pages. Internal to
 * pages. */
#pragma once

#include <jansson.h>
#include <stdbool.h>

#include "buffer.h"

/* Three significant digits, the way people write: 0.00461 is 4.61e-3, 12 is 12. */
void html_number(struct buffer *to, double value);
/* With eight digits, for what differs in the last ones. */
void html_digits(struct buffer *to, double value);

/* As printf, but %s is escaped, %-s written by html_words and %f by html_number; knows %d and %zu
 * of the integers. */
void html_format(struct buffer *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Table: <table class="..."> in a box that scrolls sideways on a narrow screen, its head row from
 * columns separated by '|' (a leading '#' marks a column of numbers). */
void html_table(struct buffer *to, const char *class, const char *columns);
void html_table_end(struct buffer *to);
void html_cell(struct buffer *to, const char *string);
void html_cell_number(struct buffer *to, double value);
void html_cell_code(struct buffer *to, const char *string);

enum html_kind { CELL_NUMBER, CELL_TEXT, CELL_WORDS, CELL_CODE, CELL_DIGITS, CELL_STATUS };

/* A column of a table whose rows are entries of the results. */
struct html_column {
    const char *head; /* as html_table has it; NULL ends a list of columns */
    /* "conservation/mass", "skips/0/bound": what the cell shows of the entry; with '^' before it,
     * of the document around the entry; NULL: the entry itself, which `cell` shows */
    const char *member;
    enum html_kind kind;
    const char *format;    /* of a number */
    const char *otherwise; /* what is shown in place of null and of nothing */
    bool finite;           /* and of what is not finite */
    void (*cell)(struct buffer *to, const json_t *value); /* writes what is in the cell */
    bool optional; /* left out where the first entry of the table has no finite number there */
};

/* COLUMN(head, member), COLUMN(head, member, .kind = CELL_TEXT) ... */
#define COLUMN(head_, ...)                                                                         \
    {                                                                                              \
        .head = head_, .member = __VA_ARGS__                                                       \
    }

/* The head of a table, to be ended by html_table_end, and a row; without optional columns. */
void html_heads(struct buffer *to, const char *class, const struct html_column *columns);
void html_row(struct buffer *to, const struct html_column *columns, const json_t *entry);
/* A table of those entries of a list that `shown` (NULL: all) lets pass; of the entries of a list
 * that each of some documents has, or (list NULL) of these documents. */
void html_list(struct buffer *to, const char *class, const struct html_column *columns,
               const json_t *list, bool (*shown)(const json_t *entry));
void html_lists(struct buffer *to, const char *class, const struct html_column *columns,
                const json_t *const *documents, size_t count, const char *list);

/* <p class="command"><code>$ command</code></p>, with what it does before it. */
void html_command(struct buffer *to, const char *what, const char *command);

/* A status as a coloured word: what passes, what is not judged, what is open (known, smoke,
 * undetermined), and all else as a failure. */
void html_status(struct buffer *to, const char *status);

/* An order with half of its interval, "1.97 ± 0.03"; the same, or a dash for NULL, as a cell. */
void html_order(struct buffer *to, const json_t *order);
void html_order_cell(struct buffer *to, const json_t *order);

/* A name of the results for people: "internal_energy" is "internal energy". */
void html_words(struct buffer *to, const char *name);
