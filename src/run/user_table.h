/* SPDX-License-Identifier: GPL-3.0-or-later
 * A table of fields against x, x and y, or r, for `reference = table FILE`, such as the result of a
 * fine run or of another code. Interpolation is by monotone cubics in x or r (Steffen 1990, no new
 * extrema at jumps), bilinear on a grid of x and y. Code units. */
#pragma once

#include "field.h"
#include "problem.h"

struct user_table;

/* Reads a CSV file (csv.h): columns x, or x and y, or r, in increasing order, and any of rho, vx,
 * vy, vz (with r: vr, vphi), P, u. A line `# time = T` gives the time. NULL: error names the
 * problem and the line; error->status is STATUS_BAD_INPUT or STATUS_ENVIRONMENT. */
struct user_table *user_table_read(const char *path, struct error *error);

void user_table_free(struct user_table *table); /* may be NULL */

double user_table_time(const struct user_table *table);

/* True if the table gives the field. u follows from rho and P, and P from rho and u; a missing
 * velocity component is 0. */
bool user_table_knows(const struct user_table *table, enum field field);

/* STATUS_BAD_INPUT: the table does not suit the dimension or does not cover the window. */
enum status user_table_check(const struct user_table *table, const struct prepared *p,
                             struct error *error);

/* The state at x; NaN: unknown. The last row holds up to one spacing beyond the end; in a periodic
 * box the last and the first row are neighbours. */
void user_table_sample(const struct user_table *table, const struct prepared *p, const double x[3],
                       struct problem_state *state);

/* Estimates the interpolation error: the difference between every second row and the interpolation
 * of the other rows. The result is the larger of two means of absolute differences: over the rows
 * in the window, by volume (for velocities, of the vector), and over the particles of a snapshot in
 * the window, since a particle between the two rows of a jump may have a large error. The error
 * with all rows is a fraction of this. NaN: unknown. */
void user_table_error(const struct user_table *table, const struct prepared *p,
                      const struct snapshot *s, double miss[FIELDS]);
