/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fixed layers at the ends of directions with boundary=fixed: the particles that start within three
 * smoothing lengths of an end. They do not move and keep their energy. The outermost third, whose
 * own sums extend into empty space, has the density of the setup; the sums of the others are
 * complete, so that moving particles next to the layer see undisturbed gas. */
#ifndef SPHPROOF_FIXED_H
#define SPHPROOF_FIXED_H

#include "status.h"

struct simulation;

/* Chooses the fixed particles from the setup's state, with h from its densities. Does nothing if no
 * end is fixed. */
enum status fixed_begin(struct simulation *simulation, struct error *error);

/* Call fixed_state after every equation of state, and fixed_rates after every computation of rates.
 */
void fixed_state(struct simulation *simulation);
void fixed_rates(struct simulation *simulation);

void fixed_free(struct simulation *simulation);

#endif
