/* SPDX-License-Identifier: GPL-3.0-or-later
 * Positions of particles of a uniform gas: regular lattices that fit a periodic box with nearly the
 * requested number of points, and quasi-random points. */
#pragma once

#include <stddef.h>

#include "field.h"
#include "settings.h"
#include "status.h"

/* Cells of a lattice, for lattice_points. */
struct lattice_plan {
    struct domain box;
    enum lattice kind;
    size_t cells[3];
    size_t n; /* total number of points */
};

/* Plans the lattice with about n points in the box. STATUS_BAD_INPUT: the lattice does not exist in
 * this dimension, or fewer than three cells fit a direction. */
enum status lattice_plan_make(struct lattice_plan *plan, const struct domain *box,
                              enum lattice kind, size_t n, struct error *error);

/* Computes the plan->n positions; seed: for random points. STATUS_BAD_INPUT: too few points for a
 * glass; STATUS_ENVIRONMENT: no memory for one. */
enum status lattice_points(const struct lattice_plan *plan, unsigned long seed, double *const x[3],
                           struct error *error);
