/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact solutions provided by a user, named by `reference` in a case file: `table FILE`
 * (user_table.h), or a shared object with parameters, `./mine.so nu=0.1` (sphproof/reference.h).
 * Each is loaded once per process. A problem with such a reference uses it for t > 0 and keeps its
 * own initial state. Only the problem `particles`, which has no initial state of its own, also
 * takes the state at t = 0 from a shared object. */
#pragma once

#include "problem.h"

enum { USER_PARAMETERS_MAX = 16, USER_SOLUTIONS_MAX = 64 };

/* True if text names a table or a shared object, not the problem's own solution. */
bool user_solution_is_named(const char *text);

/* Loads a reference. Its path is relative to the folder of `beside`, a case file. Settings refer to
 * it by *number > 0. STATUS_BAD_INPUT: an error in the file or its parameters. */
enum status user_solution_load(const char *text, const char *beside, int *number,
                               struct error *error);

/* The problem `base` with this reference as its exact solution. */
const struct problem *user_solution_problem(int number, const struct problem *base);

/* "table PATH@HASH" or "PATH@HASH nu=0.1"; HASH is of the file's content. */
const char *user_solution_name(int number);

/* Interpolation error of a table, from user_table_error; NaN for shared objects. */
void user_solution_error(const struct prepared *p, const struct snapshot *s, double miss[FIELDS]);
