/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles of equal masses that follow the density of a problem. */
#pragma once

#include "run.h"

/* Implements a problem's fill: n particles at random positions, relaxed to a glass with
 * lattice=glass. STATUS_BAD_INPUT: too few for a glass. */
enum status equal_masses_fill(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error);

/* STATUS_BAD_INPUT: the masses differ. */
enum status equal_masses_check(const struct initial *initial, struct error *error);
