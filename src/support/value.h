/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reading JSON, for pages and for the harness. What is only shown is read leniently: a missing
 * member, or one of the wrong type, is "", NaN or nothing. What is judged is needed, and a message
 * says what stands there instead. "nan", "inf" and "-inf" are numbers. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* The member of an object as a string that belongs to it; "" or fallback where it has none. */
const char *value_text(const json_t *object, const char *name);
const char *value_text_or(const json_t *object, const char *name, const char *fallback);

bool value_is_real(const json_t *value);
double value_real(const json_t *value);
/* Of the member of an object, and of one of an object within an object. */
double value_member(const json_t *object, const char *name);
double value_inner(const json_t *object, const char *outer, const char *name);

/* The first entry of a list whose name is that; NULL: there is none. */
const json_t *value_named(const json_t *list, const char *name);

/* The first numbers of an array, at most `most`; returns how many. */
size_t value_reals(const json_t *array, double *values, size_t most);

/* All numbers of an array, malloced; *n: how many. NULL and 0: no array, an empty one, or no
 * memory.
 */
double *value_numbers(const json_t *array, size_t *n);

enum { VALUE_MESSAGE = 200 };

/* A member that has to be there; NULL, or -1, with a message (VALUE_MESSAGE bytes) where it is
 * not. words: those that are allowed, ending with NULL; the place of the one that stands there. */
const json_t *value_need_list(const json_t *object, const char *name, char *message);
int value_need_word(const json_t *object, const char *name, const char *const *words,
                    char *message);
