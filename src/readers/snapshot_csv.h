/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gas of a snapshot as columns by our names (x, vx, m, rho, u, P, h, ax, du ...), for those who
 * read tables. */
#pragma once

#include "csv.h"
#include "snapshot_file.h"

/* Reads path; file: what is known beside the columns, which have moved to csv. h becomes the
 * support radius if the file proves what its h is, else the column is left out; why says so. Free
 * both, also after a failure. STATUS_BAD_INPUT: as snapshot_read. */
enum status snapshot_csv(const char *path, struct snapshot_file *file, struct csv *csv,
                         char why[200], struct error *error);
