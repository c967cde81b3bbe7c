/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact solutions of a user's own, which `reference` in a case file names: `table FILE`
 * (own_table.h), or a shared object with its parameters, `./mine.so nu=0.1` (sphproof/reference.h).
 * Each is loaded once for the life of the process. A problem with such a reference samples it at
 * t > 0, and starts as before. Only the problem `particles`, which knows no state of its own, takes
 * the state at t = 0 from a shared object as well. */
#pragma once

#include "problem.h"

enum { OWN_PARAMETERS_MAX = 16, OWN_MAX = 64 };

/* True: text means a table or a shared object, and not a problem's own solution. */
bool own_is_meant(const char *text);

/* Loads it; its path is relative to the folder of `beside`, a case file. Settings keep it as
 * *number > 0. STATUS_BAD_INPUT: what is wrong with the file or its parameters. */
enum status own_load(const char *text, const char *beside, int *number, struct error *error);

/* The problem base with that reference as its solution. */
const struct problem *own_problem(int number, const struct problem *base);

/* "table PATH@HASH" or "PATH@HASH nu=0.1"; the hash is that of the file's content. */
const char *own_name(int number);

/* How far interpolation in a table may be off, as own_table_miss says; NaN for shared objects. */
void own_miss(const struct prepared *p, const struct snapshot *s, double miss[FIELDS]);
