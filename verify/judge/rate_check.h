/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares rates of another code with ours and finds the cause of a difference: changes the choices
 * of a scheme one by one until its rates agree. */
#pragma once

#include "csv.h"
#include "rate_table.h"

enum { RATE_COLUMNS = 7, RATE_CAUSE = 160 };

struct rate_comparison {
    int column;           /* 0 to 6, named by */
    const char *quantity; /* h rho P ax ay az du */
    double worst, rms; /* |theirs - ours|, relative: h, rho, P to ours, a and du to the largest */
    size_t particle;   /* the worst one, from 0 */
    bool good;
    bool follows;           /* cause says no more than that an earlier quantity is wrong */
    char cause[RATE_CAUSE]; /* "" if nothing differs or no cause is known */
};

struct rate_check {
    size_t count;
    struct rate_comparison columns[RATE_COLUMNS];
    bool good;
};

/* Compares the columns of THEIRS.csv with the table of the setup. STATUS_BAD_INPUT: no known
 * column, or a different number of rows. */
enum status rate_check_make(struct rate_check *check, const char *path, const struct csv *theirs,
                            const struct setup *setup, const struct rate_table *ours,
                            double tolerance, struct error *error);

/* STATUS_BAD_INPUT: THEIRS.csv has positions (x, y, z; periods do not matter) that are not those of
 * the setup's particles, row by row, within 1e-5 of the box. */
enum status rate_check_positions(const char *path, const struct csv *theirs,
                                 const struct setup *setup, struct error *error);
