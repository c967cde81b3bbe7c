/* SPDX-License-Identifier: GPL-3.0-or-later
 * Maps of numerical stability: groups of cells, each a hard problem for a scheme or a prediction of
 * linear theory that short runs confirm. Every cell ends as ok, inaccurate or broke_down with a
 * reason, within a budget of steps, and names the command that repeats it. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "pool.h"
#include "stress_cell.h"

struct stress {
    struct stress_cell *cells;
    size_t count;
    bool nightly;
};

/* Lists the cells of the named groups (none: all) and adds them to a pool. STATUS_BAD_INPUT: no
 * such group. The stress must outlive the pool's run; stress_free it. */
enum status stress_plan(struct stress *stress, bool nightly, size_t group_count,
                        char *const *groups, struct pool *pool, struct error *error);

/* After pool_run: adds "cells", "groups" (titles of the maps), "atlas" (growth rates of linear
 * theory), "comparison" (where the default scheme does not survive what the seed program's method
 * does), "summary" and "failures" to a stress document. Failures are crashes, silent NaNs,
 * predictions that are not confirmed, lost comparisons; returns their number. */
size_t stress_judge(const struct stress *stress, const struct pool *pool, json_t *document);

void stress_free(struct stress *stress);
