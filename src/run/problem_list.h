/* SPDX-License-Identifier: GPL-3.0-or-later
 * The list of problems (problems.def), and the keys that each reads. */
#pragma once

#include "problem.h"

/* Its members are the struct problems, in the order of the choices of the key `kind`. */
extern const struct family problem_family;

/* The problem that the settings name. */
const struct problem *problem_of(const struct settings *settings);

/* True if the problem reads the key, or if no problem lists the key. */
bool problem_reads(const struct problem *problem, enum setting key);

/* True if the key has no meaning for the problem (`left` for a sound wave) or in this dimension. */
bool problem_foreign(const struct settings *settings, enum setting key);

/* The static name of the problem's functional that is called name; NULL: there is none. */
const char *problem_functional(const struct problem *problem, const char *name);

/* The same for any problem. */
const char *problem_functional_name(const char *name);
