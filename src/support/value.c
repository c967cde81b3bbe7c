/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "value.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *value_text_or(const json_t *object, const char *name, const char *fallback)
{
    const char *string = json_string_value(json_object_get(object, name));
    return string ? string : fallback;
}

const char *value_text(const json_t *object, const char *name)
{
    return value_text_or(object, name, "");
}

bool value_is_real(const json_t *value)
{
    const char *word = json_string_value(value);
    return json_is_number(value) ||
           (word && (!strcmp(word, "nan") || !strcmp(word, "inf") || !strcmp(word, "-inf")));
}

double value_real(const json_t *value)
{
    const char *word = json_string_value(value);
    if (json_is_number(value)) return json_number_value(value);
    if (word && !strcmp(word, "inf")) return (double)INFINITY;
    return word && !strcmp(word, "-inf") ? -(double)INFINITY : (double)NAN;
}

double value_member(const json_t *object, const char *name)
{
    return value_real(json_object_get(object, name));
}

double value_inner(const json_t *object, const char *outer, const char *name)
{
    return value_member(json_object_get(object, outer), name);
}

const json_t *value_named(const json_t *list, const char *name)
{
    size_t i;
    const json_t *entry;
    json_array_foreach(list, i, entry)
        if (strcmp(value_text(entry, "name"), name) == 0) return entry;
    return NULL;
}

size_t value_reals(const json_t *array, double *values, size_t most)
{
    size_t i, n = 0;
    const json_t *value;
    json_array_foreach(array, i, value)
        if (n < most) values[n++] = value_real(value);
    return n;
}

double *value_numbers(const json_t *array, size_t *n)
{
    const size_t size = json_array_size(array);
    double *values = size ? malloc(size * sizeof *values) : NULL;
    *n = values ? size : 0;
    for (size_t i = 0; i < *n; i++) values[i] = value_real(json_array_get(array, i));
    return values;
}

/* Describes a value of the wrong type in words. */
static void describe(const json_t *value, char *text, size_t size)
{
    static const char *const types[] = {"an object", "a list", "a string", "a number",
                                        "a number",  "true",   "false",    "null"};
    if (json_is_string(value))
        snprintf(text, size, "'%.40s'", json_string_value(value));
    else
        snprintf(text, size, "%s", value ? types[json_typeof(value)] : "nothing");
}

const json_t *value_need_list(const json_t *object, const char *name, char *message)
{
    const json_t *value = json_object_get(object, name);
    char found[64];
    if (json_is_array(value)) return value;
    describe(value, found, sizeof found);
    snprintf(message, VALUE_MESSAGE, "'%.40s' must be a list, it is %s", name, found);
    return NULL;
}

int value_need_word(const json_t *object, const char *name, const char *const *words, char *message)
{
    const json_t *value = json_object_get(object, name);
    const char *word = json_string_value(value);
    char found[64];
    for (int k = 0; word && words[k]; k++)
        if (!strcmp(word, words[k])) return k;
    describe(value, found, sizeof found);
    int used =
        snprintf(message, VALUE_MESSAGE, "'%.40s' is %s; allowed: %s", name, found, words[0]);
    for (int k = 1; words[k] && used < VALUE_MESSAGE; k++)
        used += snprintf(message + used, (size_t)(VALUE_MESSAGE - used), " %s", words[k]);
    return -1;
}
