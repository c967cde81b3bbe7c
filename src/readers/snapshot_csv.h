/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gas of a snapshot as CSV columns with our names (x, vx, m, rho, u, P, h, ax, du ...). */
#pragma once

#include "csv.h"
#include "snapshot_file.h"

/* Reads a table strictly (see csv_read) and renames columns with usual names to ours
 * (acceleration_x: ax), unless a column already has that name. said: box, boundary and gamma from
 * the comments before the rows, no columns. unknown: column names that were not recognised, or "".
 * Free csv with csv_free, also after a failure. */
enum status snapshot_csv_named(const char *path, struct snapshot_file *said, struct csv *csv,
                               char unknown[200], struct error *error);

/* Reads path and moves the columns from file to csv. h becomes the support radius if the meaning of
 * h follows from the file, else it is removed; why gives the reason. Free both, also after a
 * failure. STATUS_BAD_INPUT: as snapshot_read. */
enum status snapshot_csv(const char *path, struct snapshot_file *file, struct csv *csv,
                         char why[200], struct error *error);
