/* SPDX-License-Identifier: GPL-3.0-or-later
 * From settings to a problem with the numbers of one run. */
#pragma once

#include "problem.h"

/* The problem of the settings in dim dimensions; automatic keys of the problem get their values.
 * STATUS_BAD_INPUT: keys that cannot be together, or that the problem cannot be made of. */
enum status problem_prepare(struct prepared *p, struct settings *settings, int dim,
                            struct error *error);

/* Does the key only say how particles are laid, and not which problem it is? */
bool problem_lays_particles(const struct problem *problem, enum setting key);

/* As problem_prepare for a problem that need not be in the list. */
enum status problem_prepare_as(struct prepared *p, const struct problem *problem,
                               struct settings *settings, int dim, struct error *error);
