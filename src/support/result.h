/* SPDX-License-Identifier: GPL-3.0-or-later
 * Result documents: one JSON schema (verify/schema/sphproof-1.schema.json) for all commands. */
#pragma once

#include <jansson.h>

#include "status.h"

/* A new document with schema, command, version, git, compiler, flags, machine and date; the caller
 * owns the reference. */
json_t *result_new(const char *command);

/* A number, or the string "nan", "inf" or "-inf" if it is not finite; value_real reads it. New
 * reference. */
json_t *result_number(double value);

/* The same; null for NaN, which means no value. */
json_t *result_number_or_null(double value);

/* An array of n numbers. */
json_t *result_numbers(const double *values, size_t n);

/* Adds members to an object: result_add(object, "case=%s steps=%zu cpu_s=%g", "sod", steps, 0.2);
 * Conversions as in printf: %s string, %d int, %zu size_t, %g double, as result_number. Others: %g?
 * as result_number_or_null, %d? bool, %p a value, whose reference is taken. */
void result_add(json_t *object, const char *members, ...) __attribute__((format(printf, 2, 3)));

/* A new object with members as for result_add; NULL: no memory. */
json_t *result_object(const char *members, ...) __attribute__((format(printf, 1, 2)));

/* The document as text, 17 significant digits; malloced, NULL: no memory. */
char *result_text(const json_t *document);

/* Reads a result document. STATUS_BAD_INPUT: unreadable, not JSON, or not one of our documents. */
enum status result_load(json_t **document, const char *path, struct error *error);

/* Writes the document to path ("-": standard output), 17 significant digits; the file appears whole
 * or not at all. STATUS_ENVIRONMENT: path cannot be written. */
enum status result_write(const json_t *document, const char *path, struct error *error);
