/* SPDX-License-Identifier: GPL-3.0-or-later
 * Times the solver's sums in 2D and 3D without a simulation: search, density, matrix and force,
 * each alone or several in a row, on a slightly disordered lattice of particles at rest. A step
 * costs in addition moving, widths, the equation of state and bookkeeping. */
#pragma once

#include <stdbool.h>

#include "bench.h"
#include "cells/cells.h"
#include "scheme.h"

enum bench_cells_pass { CELLS_SEARCH = 1, CELLS_DENSITY = 2, CELLS_MATRIX = 4, CELLS_FORCE = 8 };
enum { CELLS_EVALUATION = CELLS_SEARCH | CELLS_DENSITY | CELLS_MATRIX | CELLS_FORCE };

struct bench_cells {
    struct scheme scheme; /* the sums point into it: do not move the struct */
    struct cells *cells;
    struct cells_fields fields;
    double *storage, *radius;
    unsigned passes; /* what bench_cells_work runs */
    double pairs;    /* within the larger of two smoothing lengths, each counted from both sides */
};

/* side^dim particles in a periodic box, every array that the scheme's sums read. STATUS_BAD_INPUT:
 * widths exceed half of the box; STATUS_ENVIRONMENT: no memory. Free with bench_cells_free, also
 * after a failure. */
enum status bench_cells_create(struct bench_cells *bench, const struct scheme *scheme, int dim,
                               size_t side, bool specialised, unsigned passes, struct error *error);
void bench_cells_free(struct bench_cells *bench);

/* A bench_work; context: struct bench_cells. */
enum status bench_cells_work(void *context, uint64_t times, struct clock_taken *taken,
                             struct error *error);
