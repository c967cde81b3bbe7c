/* SPDX-License-Identifier: GPL-3.0-or-later
 * A problem in a plane as periodic layers in space, for codes that know nothing else. */
#ifndef SPHPROOF_SLAB_H
#define SPHPROOF_SLAB_H

#include "initial.h"
#include "run.h"

/* A number of layers; 0: text is none. */
int slab_layers(const char *text);

/* STATUS_BAD_INPUT: not the number of layers that asked->layers may be, or the case is in another
 * dimension. */
enum status slab_ask(struct run_settings *asked, const char *layers, const char *where,
                     struct error *error);

/* Lays the particles of the run's plane once more in each of asked.layers layers, as far apart as
 * particles are in the mean; the run then has the box and the scheme of space, and the problem in
 * it serves for these alone. STATUS_BAD_INPUT: fewer layers than particles reach.
 * STATUS_ENVIRONMENT: no memory. */
enum status slab_lay(struct run *run, struct initial *initial, struct error *error);

#endif
