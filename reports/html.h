/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small parts of HTML (written as XML, so that it can be checked), for the pages. Internal to
 * pages. */
#ifndef SPHPROOF_HTML_H
#define SPHPROOF_HTML_H

#include "buffer.h"

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

/* A status as a coloured word: what passes, what is not judged, what is open (known, smoke,
 * undetermined), and all else as a failure. */
void html_status(struct buffer *to, const char *status);

/* A name of the results for people: "internal_energy" is "internal energy". */
void html_words(struct buffer *to, const char *name);

#endif
