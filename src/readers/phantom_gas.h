/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shared by Phantom's two formats (Price et al. 2018): rows for particles of all types, of which
 * type 1 is gas; one mass per type; no density, which is m (hfact/h)^3; dead or accreted particles
 * have h <= 0. */
#pragma once

#include "snapshot_file.h"

enum { PHANTOM_TYPES_MAX = 64 };

struct phantom_header {
    int types;                        /* number of masses in the header; 0: none */
    double masses[PHANTOM_TYPES_MAX]; /* of types 1, 2 ... */
    struct snapshot_value hfact, time, gamma;
    bool boxed; /* lo and hi of a periodic box are given */
    double lo[3], hi[3];
};

/* Completes a file that has positions and h: removes dead particles, sets masses, densities, time,
 * gamma and box, and moves gas to the front. type: of each row, negative between time steps; NULL:
 * all are gas. STATUS_BAD_INPUT: the header has no mass or hfact above 0. */
enum status phantom_gas(const char *path, const struct phantom_header *header, const double *type,
                        struct snapshot_file *file, struct error *error);
