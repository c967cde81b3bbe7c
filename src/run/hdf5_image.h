/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files that are built in memory and then written. They contain no dates, so equal content
 * gives equal bytes. Without the library all calls do nothing, and hdf5_image_end fails. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum hdf5_type { HDF5_CHAR, HDF5_INT, HDF5_UINT, HDF5_UINT64, HDF5_DOUBLE };

struct hdf5_image {
    int64_t file, group; /* handles of the library; group: the current group, or -1 */
    bool good;           /* nothing has failed yet */
};

/* Call this first. STATUS_ENVIRONMENT: the program was built without HDF5 or cannot load it. */
enum status hdf5_image_possible(const char *path, struct error *error);

void hdf5_image_begin(struct hdf5_image *image);

/* Creates a top-level group, to which the following calls add. */
void hdf5_image_group(struct hdf5_image *image, const char *name);

/* An attribute of the group: a scalar if count is 1, else an array. */
void hdf5_image_attribute(struct hdf5_image *image, const char *name, enum hdf5_type type,
                          const void *values, size_t count);
void hdf5_image_text(struct hdf5_image *image, const char *name, const char *text);

/* rows x columns numbers; columns = 1: a one-dimensional array. */
void hdf5_image_data(struct hdf5_image *image, const char *name, enum hdf5_type type,
                     const void *values, size_t rows, size_t columns);

/* Writes the file unless a call has failed, and frees the image. STATUS_ENVIRONMENT: no memory, no
 * library, or the file cannot be written. */
enum status hdf5_image_end(struct hdf5_image *image, const char *path, struct error *error);
