/* SPDX-License-Identifier: GPL-3.0-or-later
 * What Phantom's two formats have in common (Price et al. 2018): particles of all types in the same
 * rows, of which type 1 is gas; a mass for each type; no density, which is m (hfact/h)^3; particles
 * that are dead, or that a sink has swallowed, have h <= 0. */
#pragma once

#include "snapshot_file.h"

enum { PHANTOM_TYPES_MAX = 64 };

struct phantom_header {
    int types;                        /* masses that the header has; 0: none */
    double masses[PHANTOM_TYPES_MAX]; /* of type 1, 2 ... */
    struct snapshot_value hfact, time, gamma;
    bool boxed; /* lo and hi of a periodic box are there */
    double lo[3], hi[3];
};

/* Completes a file that has positions and h: leaves the dead ones out, sets masses and densities,
 * time, gamma and box, and puts gas first. type: of each row, negative between time steps; NULL:
 * all are gas. STATUS_BAD_INPUT: the header has no mass or hfact above 0. */
enum status phantom_gas(const char *path, const struct phantom_header *header, const double *type,
                        struct snapshot_file *file, struct error *error);
