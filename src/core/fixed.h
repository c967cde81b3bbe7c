/* SPDX-License-Identifier: GPL-3.0-or-later
 * Layers of particles whose state is kept, at the ends of directions with boundary=fixed: those
 * that start within three times their smoothing length of an end. They do not move and keep their
 * energy. The outermost third, whose own sums reach into empty space, has the density that the
 * setup gives; the sums of the others are complete, so that moving particles next to the layer feel
 * gas like their own. */
#ifndef SPHPROOF_FIXED_H
#define SPHPROOF_FIXED_H

#include "status.h"

struct simulation;

/* From the state of the setup, with h from its densities. Does nothing where no end is fixed. */
enum status fixed_begin(struct simulation *simulation, struct error *error);

/* After every equation of state, and after every sum of rates. */
void fixed_state(struct simulation *simulation);
void fixed_rates(struct simulation *simulation);

void fixed_free(struct simulation *simulation);

#endif
