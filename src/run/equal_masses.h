/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles of equal masses, as dense as the gas of a problem. */
#pragma once

#include "run.h"

/* A problem's whole fill: n particles; lattice=glass: pushed apart, else (random) as thrown.
 * STATUS_BAD_INPUT: too few for a glass. */
enum status equal_masses_fill(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error);

/* STATUS_BAD_INPUT: masses differ. */
enum status equal_masses_check(const struct initial *initial, struct error *error);
