/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gas of a snapshot as columns by our names (x, vx, m, rho, u, P, h, ax, du ...), for those who
 * read tables. */
#pragma once

#include "csv.h"
#include "snapshot_file.h"

/* Reads a table strictly, see csv_read, and calls its columns by our names where theirs are usual
 * ones (acceleration_x: ax) and no column has ours. said: what the comments before its rows say of
 * its box, boundary and gamma, no columns. unknown: names that say nothing, "" if there is none.
 * Free csv with csv_free, also after a failure. */
enum status snapshot_csv_named(const char *path, struct snapshot_file *said, struct csv *csv,
                               char unknown[200], struct error *error);

/* Reads path; file: what is known beside the columns, which have moved to csv. h becomes the
 * support radius if the file proves what its h is, else the column is left out; why says so. Free
 * both, also after a failure. STATUS_BAD_INPUT: as snapshot_read. */
enum status snapshot_csv(const char *path, struct snapshot_file *file, struct csv *csv,
                         char why[200], struct error *error);
