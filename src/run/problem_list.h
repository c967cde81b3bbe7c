/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which problems there are (problems.def), and which keys each reads. */
#pragma once

#include "problem.h"

/* Its members are those of struct problem, in the order of the key kind's choices. */
extern const struct family problem_family;

/* The problem that the settings name. */
const struct problem *problem_of(const struct settings *settings);

/* Does it read the key? True for keys that no problem calls its own. */
bool problem_reads(const struct problem *problem, enum setting key);

/* Is the key without meaning for the problem (left for a sound wave) or in so many dimensions? */
bool problem_foreign(const struct settings *settings, enum setting key);

/* The name itself, static, where the problem has a functional called so; else NULL. */
const char *problem_functional(const struct problem *problem, const char *name);

/* The same of any problem. */
const char *problem_functional_name(const char *name);
