/* SPDX-License-Identifier: GPL-3.0-or-later
 * One evaluation of the solver, in the particle order of the setup, without motion. */
#pragma once

#include "description.h"
#include "simulation.h"

struct rate_table {
    int dim;
    size_t n;
    double *h, *rho, *P, *force[3], *dU; /* n each; force = dp/dt; dU/dt of U = m u */
    struct description *described;       /* n */
    struct description_sums matrix;
    double sum_force[3], power; /* sums; power: rate of change of the total energy */
    double *storage;
};

/* STATUS_BAD_INPUT: the setup is refused; STATUS_BROKE_DOWN: invalid state; STATUS_ENVIRONMENT: no
 * memory. Free with rate_table_free, also after a failure. */
enum status rate_table_make(struct rate_table *table, const struct setup *setup,
                            struct error *error);
void rate_table_free(struct rate_table *table);
