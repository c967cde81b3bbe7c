/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where particles of a uniform gas stand: regular lattices that fit a box with the
 * number of points next to what is asked for, periodically, and quasi-random points. */
#pragma once

#include <stddef.h>

#include "field.h"
#include "settings.h"
#include "status.h"

/* Points per direction and per cell of a lattice; what lattice_points places. */
struct lattice_plan {
    struct domain box;
    enum lattice kind;
    size_t cells[3];
    size_t n; /* points in all */
};

/* The lattice with about n points in the box. STATUS_BAD_INPUT: this lattice does not exist in so
 * many dimensions; fewer than three cells fit a direction. */
enum status lattice_plan_make(struct lattice_plan *plan, const struct domain *box,
                              enum lattice kind, size_t n, struct error *error);

/* The points: plan->n per direction, in the box; seed: of those that are random. STATUS_BAD_INPUT:
 * too few for a glass; STATUS_ENVIRONMENT: no memory for one. */
enum status lattice_points(const struct lattice_plan *plan, unsigned long seed, double *const x[3],
                           struct error *error);
