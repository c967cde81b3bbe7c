/* SPDX-License-Identifier: GPL-3.0-or-later
 * What an autopsy reads off the state in which a run ends. Internal to autopsy. */
#pragma once

#include "autopsy.h"

/* One evaluation for each term that the scheme has, and one without them. STATUS_*: as
 * rate_table_make. */
enum status autopsy_power(const struct run *run, const struct snapshot *state,
                          struct autopsy_power power[AUTOPSY_TERMS], struct error *error);

/* Cells of AUTOPSY_CELL spacings in each direction (in 1D twice that), in which fields are split;
 * {0} is none. */
enum { AUTOPSY_CELL = 4 };
struct autopsy_cells {
    const struct prepared *problem;
    size_t n, along[3], count, *place; /* of each particle */
    double *const *x, *weight;         /* not owned */
    struct autopsy_cell *of;
    double aimed; /* root of the mean square of what is smooth in the velocity's error; 0: none */
};

/* x: dim arrays of n positions, weight: n; both must stay. STATUS_ENVIRONMENT: no memory; free with
 * autopsy_cells_free, also after a failure. */
enum status autopsy_cells_make(struct autopsy_cells *cells, const struct prepared *problem,
                               size_t n, double *const x[3], double *weight, struct error *error);
void autopsy_cells_free(struct autopsy_cells *cells);

/* From now on a - b is the velocity's error, along which fields may point. */
void autopsy_cells_aim(struct autopsy_cells *cells, double *const a[3], double *const b[3]);

/* Of n vectors a - b, or a where b is NULL. */
struct autopsy_split autopsy_split(const struct autopsy_cells *cells, double *const a[3],
                                   double *const b[3]);
