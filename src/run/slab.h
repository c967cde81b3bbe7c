/* SPDX-License-Identifier: GPL-3.0-or-later
 * A problem in 2D given as periodic layers in 3D, for codes that know only 3D. */
#pragma once

#include "initial.h"
#include "run.h"

/* The number of layers that text gives, or 0 if it is not one. */
int slab_layers(const char *text);

/* Sets asked->layers. STATUS_BAD_INPUT: layers is not an allowed number, or the case is not in 2D.
 */
enum status slab_ask(struct run_settings *asked, const char *layers, const char *where,
                     struct error *error);

/* Repeats the particles of the run's plane in each of asked.layers layers, which lie as far apart
 * as particles are in the mean. The run then has a box and a scheme in 3D; its problem is only good
 * for this initial state. STATUS_BAD_INPUT: fewer layers than the kernel reaches across.
 * STATUS_ENVIRONMENT: no memory. */
enum status slab_lay(struct run *run, struct initial *initial, struct error *error);
