/* SPDX-License-Identifier: GPL-3.0-or-later
 * Layers of particles whose state is kept, at the ends of directions with boundary=fixed: those
 * that start within three times their smoothing length of an end. They do not move and keep their
 * energy. The outermost third, whose own sums see the emptiness outside, has the density that the
 * scene says; the others' sums are complete, so that moving particles next to the layer feel gas
 * like their own. */
#ifndef SPHPROOF_HOLD_H
#define SPHPROOF_HOLD_H

#include "status.h"

struct simulation;

/* From the state of the scene, with h from its densities. Does nothing where no end is fixed. */
enum status hold_begin(struct simulation *simulation, struct error *error);

/* After every equation of state, and after every sum of rates. */
void hold_state(struct simulation *simulation);
void hold_rates(struct simulation *simulation);

void hold_free(struct simulation *simulation);

#endif
