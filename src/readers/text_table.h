/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines and numbers of text snapshots; the bytes end with a NUL. */
#pragma once

#include "snapshot_file.h"
#include "source.h"

enum { TABLE_COLUMNS_MAX = 64 };

struct text_table {
    const struct snapshot_source *source;
    size_t columns;
    char names[TABLE_COLUMNS_MAX][48];
    int meaning[TABLE_COLUMNS_MAX]; /* snapshot_column, -1: not read, TABLE_TYPE */
    char separator;                 /* ',' or, for blanks, ' ' */
    char unit[24];                  /* a unit between the names of the columns, else "" */
};
enum { TABLE_TYPE = SNAPSHOT_COLUMNS };

/* True if the first bytes are text. */
bool text_table_is_text(const struct snapshot_source *source);

/* Sets the meaning of each column from the user's map, "rho=Density,u=Energy" (NULL: no map), or
 * from the usual names. STATUS_BAD_INPUT: a column of the map is missing, or two columns mean the
 * same quantity. */
enum status text_table_name(struct text_table *table, const char *map, struct error *error);

/* As text_real, but also accepts Fortran's exponent D. */
bool text_table_number(const char *word, double *value);

/* Reads the rows from byte `from` (on the given line), gas first. STATUS_BAD_INPUT: a row with text
 * that is not a number, or of another length; the message gives the position. */
enum status text_table_read(const struct text_table *table, size_t from, size_t line,
                            struct snapshot_file *file, struct error *error);
