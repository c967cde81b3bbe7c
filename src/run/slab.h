/* SPDX-License-Identifier: GPL-3.0-or-later
 * A 2D problem repeated in periodic layers, for codes that only run in 3D. */
#pragma once

#include "initial.h"
#include "run.h"

/* Parses a number of layers; 0: text is not one. */
int slab_layers(const char *text);

/* Sets asked->layers. STATUS_BAD_INPUT: layers is not an allowed number, or the case is not in
 * 2D. */
enum status slab_ask(struct run_settings *asked, const char *layers, const char *where,
                     struct error *error);

/* Repeats the 2D particles in asked.layers layers, separated by the mean particle spacing. The run
 * then has a box and a scheme in 3D, and its problem is valid only for this initial state.
 * STATUS_BAD_INPUT: too few layers for the kernel's support. STATUS_ENVIRONMENT: no memory. */
enum status slab_lay(struct run *run, struct initial *initial, struct error *error);
