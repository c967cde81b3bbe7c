/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines and numbers of snapshots that are text: cut out of the bytes, which end with a NUL. */
#pragma once

#include "snapshot_file.h"
#include "source.h"

enum { TABLE_COLUMNS_MAX = 64 };

struct text_table {
    const struct snapshot_source *source;
    size_t columns;
    char names[TABLE_COLUMNS_MAX][48];
    int meaning[TABLE_COLUMNS_MAX]; /* snapshot_column, -1: not read, TABLE_TYPE */
    char separator;                 /* ',' or ' ' for blanks */
};
enum { TABLE_TYPE = SNAPSHOT_COLUMNS };

/* Are its first bytes all text? */
bool text_table_is_text(const struct snapshot_source *source);

/* Sets the meaning of each column from the user's map, "rho=Density,u=Energy" (NULL: no map), or
 * from the usual names. STATUS_BAD_INPUT: the map names a column that is not there, or two columns
 * mean the same quantity. */
enum status text_table_name(struct text_table *table, const char *map, struct error *error);

/* As text_real; Fortran's exponent D counts as E. */
bool text_table_number(const char *word, double *value);

/* Reads the rows from the byte `from` on (line: its number), gas first. STATUS_BAD_INPUT: place of
 * what is no number, of rows of another length. */
enum status text_table_read(const struct text_table *table, size_t from, size_t line,
                            struct snapshot_file *file, struct error *error);
