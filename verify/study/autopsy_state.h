/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures the final state of a run for an autopsy. Internal to autopsy. */
#pragma once

#include "autopsy.h"

/* Evaluates once for each term of the scheme and once without them. STATUS_*: as
 * rate_table_make. */
enum status autopsy_power(const struct run *run, const struct snapshot *state,
                          struct autopsy_power power[AUTOPSY_TERMS], struct error *error);

/* Cells of AUTOPSY_CELL spacings in each direction (in 1D twice that) in which fields are split
 * into smooth part and noise; {0} is none. */
enum { AUTOPSY_CELL = 4 };
struct autopsy_cells {
    const struct prepared *problem;
    size_t n, along[3], count, *place; /* cell of each particle */
    double *const *x, *weight;         /* not owned */
    struct autopsy_cell *of;
    double aimed; /* rms of the smooth part of the velocity's error; 0: none */
};

/* x: dim arrays of n positions, weight: n values; both must outlive the cells. STATUS_ENVIRONMENT:
 * no memory. Call autopsy_cells_free even after a failure. */
enum status autopsy_cells_make(struct autopsy_cells *cells, const struct prepared *problem,
                               size_t n, double *const x[3], double *weight, struct error *error);
void autopsy_cells_free(struct autopsy_cells *cells);

/* Sets a - b as the velocity's error, along which autopsy_split projects. */
void autopsy_cells_aim(struct autopsy_cells *cells, double *const a[3], double *const b[3]);

/* Splits n vectors a - b, or a if b is NULL. */
struct autopsy_split autopsy_split(const struct autopsy_cells *cells, double *const a[3],
                                   double *const b[3]);
