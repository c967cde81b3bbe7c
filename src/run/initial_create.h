/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles of a run at t = 0: those of its problem or of a file, then disturbed as the settings
 * say. */
#ifndef SPHPROOF_INITIAL_CREATE_H
#define SPHPROOF_INITIAL_CREATE_H

#include "initial.h"
#include "problem.h"

/* The particles of a prepared problem, moved as the keys lattice and jitter ask; settings:
 * resolved. STATUS_BAD_INPUT: the problem cannot fill its domain with them. */
enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error);

#endif
