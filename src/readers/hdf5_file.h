/* SPDX-License-Identifier: GPL-3.0-or-later
 * The few things that readers ask of an HDF5 file. Its library does not withstand hostile files, so
 * that snapshot_read lets it work in a process of its own (guard.h). */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "snapshot_file.h"
#include "source.h"

/* Loads the library, for a file. STATUS_BAD_INPUT: this program was built without it.
 * STATUS_ENVIRONMENT: it is there no more. */
enum status hdf5_load(const char *path, struct error *error);

/* Opens source->file, after hdf5_load. STATUS_BAD_INPUT: the library cannot make sense of it. */
enum status hdf5_open(struct snapshot_source *source, struct error *error);
void hdf5_close(struct snapshot_source *source);

/* Is there such a group or dataset: "PartType0/Density"? */
bool hdf5_has(const struct snapshot_source *source, const char *path);

/* Names of the links of a group, "A B C", for messages. */
void hdf5_names(const struct snapshot_source *source, const char *group, char *text, size_t size);

/* Name of the last link of a group that begins with prefix, by the number behind it; false: none.
 */
bool hdf5_last(const struct snapshot_source *source, const char *group, const char *prefix,
               char *name, size_t size);

/* Numbers of an attribute of the group, or of a dataset in it, into values, how many there are (at
 * most max are set); a scalar is a list of one. -1: there is neither, or it holds no numbers. */
int hdf5_numbers(const struct snapshot_source *source, const char *group, const char *name,
                 double *values, int max);

/* A text, kept like numbers, cleaned; "" where there is none. */
void hdf5_text(const struct snapshot_source *source, const char *group, const char *name,
               char *text, size_t size);

/* What stands there in place of a table of numbers, for messages: "a group", "text", "numbers with
 * 3 indices", "something else". */
void hdf5_kind(const struct snapshot_source *source, const char *path, char *text, size_t size);

/* Rows of what stands there; 0: it is no dataset of numbers. */
size_t hdf5_rows(const struct snapshot_source *source, const char *path);

/* Reads a dataset of file->n rows and at most 3 columns into column and those behind it.
 * STATUS_BAD_INPUT: not of that shape, or it cannot be read. Sets the precision. */
enum status hdf5_read(const struct snapshot_source *source, const char *path,
                      struct snapshot_file *file, enum snapshot_column column, struct error *error);
