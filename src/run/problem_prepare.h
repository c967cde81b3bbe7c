/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes a problem with the numbers of one run from settings. */
#pragma once

#include "problem.h"

/* Prepares the problem of the settings in dim dimensions and sets its automatic keys.
 * STATUS_BAD_INPUT: the keys contradict each other, or no problem can be made from them. */
enum status problem_prepare(struct prepared *p, struct settings *settings, int dim,
                            struct error *error);

/* True if the key only arranges particles and does not change the problem. */
bool problem_lays_particles(const struct problem *problem, enum setting key);

/* As problem_prepare for any problem, listed or not. */
enum status problem_prepare_as(struct prepared *p, const struct problem *problem,
                               struct settings *settings, int dim, struct error *error);
