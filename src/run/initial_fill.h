/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ways in which several problems lay their particles. */
#ifndef SPHPROOF_INITIAL_FILL_H
#define SPHPROOF_INITIAL_FILL_H

#include "initial.h"
#include "problem.h"

/* A problem's whole fill, where all of the domain is laid so: equal spacing, masses that follow the
 * density; or, with equal_masses=yes of a problem that reads the key, equal masses at places that
 * follow it. */
enum status initial_fill(const struct prepared *p, const struct settings *settings,
                         struct initial *initial, struct error *error);

/* A problem's whole fill with a ball (a disc, an interval) in the middle of the domain: about n
 * particles. */
enum status initial_fill_ball(const struct prepared *p, const struct settings *settings,
                              double radius, struct initial *initial, struct error *error);

#endif
