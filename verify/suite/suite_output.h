/* SPDX-License-Identifier: GPL-3.0-or-later
 * Output of the checks: a table, the JSON document, a JUnit file, and for each failed check files
 * with its figures and data. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "suite.h"

/* Prints one line per check (its figure nearest to its bound), with details failures figure by
 * figure, then mutants, and finally the headlines (headline_list). */
void suite_output_table(const struct suite *suite, FILE *stream, bool color, bool details);

/* Adds checks, mutants and summary to document. */
void suite_output_json(const struct suite *suite, json_t *document);

/* The series that a check (NULL: any) added, [{"label", "x", "y"}]; new reference. */
json_t *suite_output_series(const struct suite *suite, const struct check *check);

/* JUnit XML, as of a report: a test suite for each group and one for the mutants. */
enum status suite_output_junit(const struct suite *suite, const char *path, struct error *error);

/* Writes folder/GROUP-NAME.json for each failed check (figures, series) and, if gnuplot is
 * available, folder/GROUP-NAME.svg; names them on stream unless that is NULL. Makes the folder if
 * needed and removes an earlier run's files of the checks that ran now. */
enum status suite_output_failures(const struct suite *suite, const char *folder, FILE *stream,
                                  struct error *error);

/* The failures in one line for each member: a wrong kernel fails in dozens of figures, which are
 * one fault. A member is the beginning of a figure's subject, up to its first comma or colon.
 * [{"rank", "group", "check", "member", "headline", "property", "place", "value", "bound", "ratio",
 * "figures", "also": [checks], "command", "data"}]: one for each failed member and each missed
 * mutant, the most specific and clearest failure first. check, value, bound, place belong to the
 * most specific figure; data: the name of its files (suite_output_failures), without endings. New
 * reference; NULL: no memory. */
json_t *headline_list(const struct suite *suite);

/* Prints each headline and below it the ratio to the bound, the place, and the other failed
 * checks. */
void headline_print(const json_t *headlines, FILE *stream, bool color);
