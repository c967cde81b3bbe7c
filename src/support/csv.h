/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables of numbers in CSV files, read strictly: one line of distinct column names, then lines with
 * as many finite decimal numbers (also Fortran's 1.0D0), separated by commas or, if the names have
 * none, by blanks. Blank lines, lines that begin with '#', blanks around values, CRLF and a byte
 * order mark are allowed; anything else is an error with its position. */
#pragma once

#include <stddef.h>

#include "status.h"

enum { CSV_LINE_MAX = 1 << 16, CSV_COLUMNS_MAX = 256, CSV_MEGABYTES_MAX = 512 };

struct csv {
    size_t columns, rows;
    char *names[CSV_COLUMNS_MAX];
    double *values[CSV_COLUMNS_MAX]; /* rows each */
    size_t *line;                    /* rows values: line number in the file, from 1 */
    size_t capacity;
};

/* STATUS_BAD_INPUT with "path:line:character: what; allowed ..." if the file is missing, a
 * directory, empty, binary, too large or not such a table; STATUS_ENVIRONMENT: no memory. Call
 * csv_free also after a failure. */
enum status csv_read(const char *path, struct csv *csv, struct error *error);
void csv_free(struct csv *csv);

/* Index of the column called name, or -1. */
int csv_column(const struct csv *csv, const char *name);
