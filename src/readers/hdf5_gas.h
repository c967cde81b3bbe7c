/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the HDF5 layouts have in common: a group with a dataset for each quantity, a header. */
#pragma once

#include "hdf5_file.h"

/* Names of a quantity, the first that is there counts. */
struct hdf5_names {
    enum snapshot_column column;
    const char *names[4]; /* ends with NULL */
    bool needed;
};

/* Reads the datasets of a group; positions come first in the list and give the number of rows.
 * STATUS_BAD_INPUT: one is missing that is needed (and what there is), or cannot be read. */
enum status hdf5_gas(const struct snapshot_source *source, const char *group,
                     const struct hdf5_names *names, size_t n, struct snapshot_file *file,
                     struct error *error);

/* The first of the attributes "group:name" that is there. */
struct snapshot_value hdf5_first(const struct snapshot_source *source, const char *const *from,
                                 const char **used);

/* "Header": time, box, number of files, mass of the gas where a table holds it.
 * STATUS_BAD_INPUT: comoving units, counts that do not agree. */
enum status hdf5_header(const struct snapshot_source *source, struct snapshot_file *file,
                        struct error *error);
