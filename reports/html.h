/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small parts of HTML (written as XML, so that it can be checked) and of JSON reading, for the
 * pages. Internal to pages. */
#ifndef SPHPROOF_HTML_H
#define SPHPROOF_HTML_H

#include <jansson.h>

#include "buffer.h"

/* Reading: a missing member, or one of the wrong type, is "", NaN, 0; "nan", "inf", "-inf" are
 * numbers. Only objects have members. */
const char *html_string(const json_t *object, const char *name);
double html_real(const json_t *value);
double html_member(const json_t *object, const char *name);
/* The member of an object within an object. */
double html_member2(const json_t *object, const char *outer, const char *name);

/* The first numbers of an array, at most `most`; returns how many. */
size_t html_numbers(const json_t *array, double *values, size_t most);

/* Three significant digits, the way people write: 0.00461 is 4.61e-3, 12 is 12. */
void html_number(struct buffer *to, double value);

/* Table: <table class="..."> in a box that scrolls sideways on a narrow screen, its head row from
 * columns separated by '|' (a leading '#' marks a column of numbers). */
void html_table(struct buffer *to, const char *class, const char *columns);
void html_table_end(struct buffer *to);
void html_cell(struct buffer *to, const char *string);
void html_cell_number(struct buffer *to, double value);
/* With eight digits, for what differs in the last ones. */
void html_cell_digits(struct buffer *to, double value);
void html_cell_code(struct buffer *to, const char *string);

/* <p class="command"><code>$ command</code></p>, with what it does before it. */
void html_command(struct buffer *to, const char *what, const char *command);

/* pass, fail or skip as a coloured word. */
void html_status(struct buffer *to, const char *status);

/* The command that computes a verify document again, without its groups. */
const char *html_verify(const json_t *verify);

/* A name of the results for people: "internal_energy" is "internal energy". */
void html_words(struct buffer *to, const char *name);

#endif
