/* SPDX-License-Identifier: GPL-3.0-or-later
 * A table of fields against x, x and y, or r, for `reference = table FILE`: what a fine run or
 * another code has found. Between the rows of x or r monotone cubics (Steffen 1990, which make no
 * new extrema at jumps), on a grid of x and y bilinear. Code units. */
#pragma once

#include "field.h"
#include "problem.h"

struct own_table;

/* Reads a CSV file (csv.h): columns x, or x and y, or r, which rise, and any of rho, vx, vy, vz
 * (with r: vr, vphi), P, u; a line `# time = T` says of which time. NULL: what is wrong, with the
 * line. STATUS_BAD_INPUT, STATUS_ENVIRONMENT in error->status. */
struct own_table *own_table_read(const char *path, struct error *error);

void own_table_free(struct own_table *table); /* NULL: nothing */

double own_table_time(const struct own_table *table);

/* Is anything of the field in the table? u follows from rho and P, and P
 * from rho and u; a component of the velocity that is not there is 0. */
bool own_table_knows(const struct own_table *table, enum field field);

/* STATUS_BAD_INPUT: it has no form in these dimensions, or does not cover the window. */
enum status own_table_check(const struct own_table *table, const struct prepared *p,
                            struct error *error);

/* The state at x; NaN: unknown. Up to one spacing beyond its ends the last row holds, and round a
 * periodic box the last row and the first are neighbours. */
void own_table_sample(const struct own_table *table, const struct prepared *p, const double x[3],
                      struct problem_state *state);

/* How far the table is off the rows that are left out of it when only every second one is kept:
 * means of the absolute differences over the rows in the window, by volume (of velocities: of the
 * vector's), or over the particles of a snapshot in it, whichever is more: a particle between the
 * two rows of a jump may be off by much. With all rows it is off by a fraction of that. NaN: not
 * known. */
void own_table_miss(const struct own_table *table, const struct prepared *p,
                    const struct snapshot *s, double miss[FIELDS]);
