/* SPDX-License-Identifier: GPL-3.0-or-later
 * Words and numbers as people type them: strict parsing, near misses, messages that list what is
 * allowed. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "family.h"
#include "status.h"

/* The whole of text as a decimal number; false for anything else ("", "1e3x", "0x10", "nan",
 * "inf", blanks, a number too large for a double). *value is then untouched. */
bool text_real(const char *text, double *value);

/* The whole of text as a decimal integer; "1e3" is one, "1.5" and "1e12x" are not. Kept as a double
 * so that a range check can speak about 1e12 as well. */
bool text_integer(const char *text, double *value);

/* The same, or BASE^EXPONENT: "64^2" is 4096. *exponent is 0 for a plain integer. */
bool text_count(const char *text, double *value, int *exponent);

/* Exactly n numbers separated by any of separators (a run of blanks is one separator). */
bool text_reals(const char *text, const char *separators, size_t n, double *values);

/* Edit distance (insert, delete, replace, swap neighbours), letters of either case being equal. */
size_t text_distance(const char *a, const char *b);

/* The one of names that was probably meant, or NULL where nothing is near. */
const char *text_nearest(const char *word, const char *const *names, size_t n);

/* STATUS_BAD_INPUT with "where: no KIND 'word'; did you mean 'near'? allowed: a b c". where may be
 * NULL. */
enum status text_unknown(struct error *error, const char *where, const char *kind, const char *word,
                         const char *const *names, size_t n);

/* The same for the members of a family. */
enum status text_unknown_member(struct error *error, const char *where, const char *kind,
                                const char *word, const struct family *family);
