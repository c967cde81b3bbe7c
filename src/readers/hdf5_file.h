/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 access for the readers. The library is not robust against malicious files, so that
 * snapshot_read runs it in a child process (guard.h). */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "snapshot_file.h"
#include "source.h"

/* Opens source->file, after h5_load. STATUS_BAD_INPUT: the library cannot read it. */
enum status hdf5_open(struct snapshot_source *source, struct error *error);
void hdf5_close(struct snapshot_source *source);

/* True if the group or dataset exists: "PartType0/Density". */
bool hdf5_has(const struct snapshot_source *source, const char *path);

/* Names of the links in a group, "A B C", for messages. */
void hdf5_names(const struct snapshot_source *source, const char *group, char *text, size_t size);

/* Name of the link in a group with this prefix and the largest number after it; false: none. */
bool hdf5_last(const struct snapshot_source *source, const char *group, const char *prefix,
               char *name, size_t size);

/* Reads an attribute of the group, or a dataset in it, into values. Returns the number of values,
 * of which at most max are stored; a scalar has one. 0: missing or not numeric. */
int hdf5_numbers(const struct snapshot_source *source, const char *group, const char *name,
                 double *values, int max);

/* Reads a string stored like numbers, sanitised; "" if missing. */
void hdf5_text(const struct snapshot_source *source, const char *group, const char *name,
               char *text, size_t size);

/* Describes an object that is not a table of numbers, for messages: "a group", "text", "numbers
 * with 3 indices", "something else". */
void hdf5_kind(const struct snapshot_source *source, const char *path, char *text, size_t size);

/* Number of rows; 0: not a numeric dataset. */
size_t hdf5_rows(const struct snapshot_source *source, const char *path);

/* Reads a dataset of file->n rows and at most 3 columns into `column` and the following ones.
 * STATUS_BAD_INPUT: another shape, or unreadable. Sets the precision. */
enum status hdf5_read(const struct snapshot_source *source, const char *path,
                      struct snapshot_file *file, enum snapshot_column column, struct error *error);
