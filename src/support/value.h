/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reading JSON, for pages and for the harness. Values for display are read leniently: a missing
 * member, or one of the wrong type, is "", NaN or nothing. Values that are judged are required, and
 * a message describes what was found instead. "nan", "inf" and "-inf" are numbers. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

/* The member of an object as a string owned by it; "" or fallback if there is none. */
const char *value_text(const json_t *object, const char *name);
const char *value_text_or(const json_t *object, const char *name, const char *fallback);

bool value_is_real(const json_t *value);
double value_real(const json_t *value);
/* The number of a member of an object, and of a member of an object within an object. */
double value_member(const json_t *object, const char *name);
double value_inner(const json_t *object, const char *outer, const char *name);

/* The first entry of a list with this name; NULL: none. */
const json_t *value_named(const json_t *list, const char *name);

/* Reads the first numbers of an array, at most `most`; returns their number. */
size_t value_reals(const json_t *array, double *values, size_t most);

/* All numbers of an array, malloced; *n: their number. NULL and 0: no array, an empty one, or no
 * memory. */
double *value_numbers(const json_t *array, size_t *n);

enum { VALUE_MESSAGE = 200 };

/* A required member; NULL, or -1, with a message (VALUE_MESSAGE bytes) if it is missing. words:
 * allowed words, ending with NULL; returns the index of the one found. */
const json_t *value_need_list(const json_t *object, const char *name, char *message);
int value_need_word(const json_t *object, const char *name, const char *const *words,
                    char *message);
