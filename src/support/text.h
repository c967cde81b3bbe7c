/* SPDX-License-Identifier: GPL-3.0-or-later
 * Words and numbers typed by users: strict parsing, near misses, messages that list what is
 * allowed. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "family.h"
#include "status.h"

/* Reads all of text as a decimal number; false, with *value unchanged, for anything else ("",
 * "1e3x", "0x10", "nan", "inf", blanks, a number too large for a double). */
bool text_real(const char *text, double *value);

/* Reads all of text as a decimal integer, including "1e3", but not "1.5" or "1e12x". A double, so
 * that range checks can report 1e12 as well. */
bool text_integer(const char *text, double *value);

/* As text_integer, or BASE^EXPONENT: "64^2" is 4096. *exponent is 0 for a plain integer. */
bool text_count(const char *text, double *value, int *exponent);

/* Reads exactly n numbers separated by any of separators (a run of blanks is one separator). */
bool text_reals(const char *text, const char *separators, size_t n, double *values);

/* True if the last dot begins this ending: ".ini". */
bool text_ends(const char *text, const char *ending);

/* Edit distance (insert, delete, replace, swap neighbours), ignoring case. */
size_t text_distance(const char *a, const char *b);

/* The most similar of names, or NULL if none is similar. */
const char *text_nearest(const char *word, const char *const *names, size_t n);

/* Copies word for a message: shortened, with '?' for unprintable characters. */
void text_printable(const char *word, char *copy, size_t size);

/* Some editors begin a file with it. */
#define TEXT_BYTE_ORDER_MARK "\xef\xbb\xbf"

/* Appends to the text as far as the size allows. */
void text_add(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* STATUS_BAD_INPUT with "where: no KIND 'word'; did you mean 'near'? allowed: a b c". where may be
 * NULL. */
enum status text_unknown(struct error *error, const char *where, const char *kind, const char *word,
                         const char *const *names, size_t n);

/* As text_unknown, for the members of a family. */
enum status text_unknown_member(struct error *error, const char *where, const char *kind,
                                const char *word, const struct family *family);
