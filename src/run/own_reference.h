/* SPDX-License-Identifier: GPL-3.0-or-later
 * Solutions of a user's own: what `reference` in a case file names beside those of the problems,
 * `table FILE` (own_table.h) or a shared object with parameters, `./mine.so nu=0.1`
 * (sphproof/reference.h). Each is loaded once for the life of the process. A problem with such a
 * reference is the same problem with another sample: what it starts from stays, but for problems
 * that take particles from files, which then know a start. */
#ifndef SPHPROOF_OWN_REFERENCE_H
#define SPHPROOF_OWN_REFERENCE_H

#include "problem.h"

enum { OWN_PARAMETERS_MAX = 16, OWN_MAX = 64 };

/* Is this a table or a shared object, not the name of a problem's solution? */
bool own_is_meant(const char *text);

/* Loads it, relative to the folder that `beside` (the path of a case file) is in; *number > 0 is
 * what settings carry. STATUS_BAD_INPUT: what is wrong with the file or its parameters. */
enum status own_load(const char *text, const char *beside, int *number, struct error *error);

/* A problem of problem_family, solved by that reference. */
const struct problem *own_problem(int number, const struct problem *base);

/* "table PATH@HASH" or "PATH@HASH nu=0.1": what it is, with its content. */
const char *own_name(int number);

/* How far interpolation in a table may be off (own_table_miss); NaN: it is no table. */
void own_miss(const struct prepared *p, const struct snapshot *s, double miss[FIELDS]);

#endif
