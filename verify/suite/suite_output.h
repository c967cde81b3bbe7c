/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run of checks tells: a table for people, the JSON document, a JUnit file, and for each
 * failing check a folder entry with its figures and data. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "suite.h"

/* One line a check (its figure nearest to its bound), with details failures figure by figure, then
 * mutants, and at the end what failed (headline_list). */
void suite_output_table(const struct suite *suite, FILE *stream, bool color, bool details);

/* Adds checks, mutants and summary to document. */
void suite_output_json(const struct suite *suite, json_t *document);

/* The data that a check (NULL: any) gave along with its figures, [{"label", "x", "y"}]; new
 * reference. */
json_t *suite_output_series(const struct suite *suite, const struct check *check);

/* JUnit XML, as of a report: a test suite for each group and one for the mutants. */
enum status suite_output_junit(const struct suite *suite, const char *path, struct error *error);

/* Writes folder/GROUP-NAME.json for each failing check (figures, series) and, where gnuplot is
 * there, folder/GROUP-NAME.svg; names them on stream if that is not NULL. The folder is made if
 * needed; what an earlier run left there of a check that ran now is taken away. */
enum status suite_output_failures(const struct suite *suite, const char *folder, FILE *stream,
                                  struct error *error);

/* What failed, in a line for each member: a wrong kernel fails in dozens of figures, and they are
 * one fault. A member is what a figure's subject begins with, up to its first comma or colon.
 * [{"rank", "group", "check", "member", "headline", "property", "place", "value", "bound", "ratio",
 * "figures", "also": [checks], "command", "data"}]: one for each member that failed and each mutant
 * that was missed, what is most specific and fails most clearly first. check, value, bound, place
 * are those of the figure that says most; data: the name of its files (suite_output_failures),
 * without their endings. New reference; NULL: no memory. */
json_t *headline_list(const struct suite *suite);

/* For people: each headline, and below it how far over the bound, where, and what else fails. */
void headline_print(const json_t *headlines, FILE *stream, bool color);
