/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shared by the HDF5 layouts: a group with a dataset for each quantity, and a header. */
#pragma once

#include "hdf5_file.h"

/* Names of a quantity; the first that exists is used. */
struct hdf5_names {
    enum snapshot_column column;
    const char *names[4]; /* NULL-terminated */
    bool needed;
};

/* Reads the datasets of a group; positions come first in the list and give the number of rows.
 * STATUS_BAD_INPUT: the group or a required dataset is missing (the message lists what exists), or
 * unreadable. */
enum status hdf5_gas(const struct snapshot_source *source, const char *group,
                     const struct hdf5_names *names, size_t n, struct snapshot_file *file,
                     struct error *error);

/* One number of the header, or the first of several. */
struct snapshot_value hdf5_number(const struct snapshot_source *source, const char *group,
                                  const char *name);

/* The first attribute "group:name" that exists. */
struct snapshot_value hdf5_first(const struct snapshot_source *source, const char *const *from,
                                 const char **used);

/* Reads "Header": time, box, number of files, and the mass of gas particles if a table has it.
 * STATUS_BAD_INPUT: comoving units, or inconsistent counts. */
enum status hdf5_header(const struct snapshot_source *source, struct snapshot_file *file,
                        struct error *error);
