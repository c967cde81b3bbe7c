/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles of a run at t = 0. Riemann problems: equal masses, cell-centred on each side, or graded
 * towards the jumps. Sound wave: equal masses whose positions carry the density exactly. */
#ifndef SPHPROOF_INITIAL_H
#define SPHPROOF_INITIAL_H

#include <stddef.h>

#include "exact.h"
#include "settings.h"
#include "status.h"

struct initial {
    size_t n;
    double *x, *v, *m, *u, *rho; /* n each, rising x; code units */
    double *storage;
};

/* settings: resolved. STATUS_BAD_INPUT: they leave a side without particles; STATUS_ENVIRONMENT: no
 * memory. */
enum status initial_create(struct initial *initial, const struct settings *settings,
                           const struct exact *exact, struct error *error);
void initial_free(struct initial *initial);

#endif
