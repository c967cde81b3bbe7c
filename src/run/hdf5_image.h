/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files that are made in memory and written as any other file. They hold no times: equal
 * content gives equal bytes. Without the library all calls do nothing, and hdf5_image_end says so.
 */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum hdf5_type { HDF5_CHAR, HDF5_INT, HDF5_UINT, HDF5_UINT64, HDF5_DOUBLE };

struct hdf5_image {
    int64_t file, group; /* of the library; group: the one that is filled now, or -1 */
    bool good;           /* nothing has failed yet */
};

/* Before all others. STATUS_ENVIRONMENT: this program was built without HDF5, or cannot load it. */
enum status hdf5_image_possible(const char *path, struct error *error);

void hdf5_image_begin(struct hdf5_image *image);

/* Makes a group at the top of the file; what follows belongs to it. */
void hdf5_image_group(struct hdf5_image *image, const char *name);

/* Numbers of the group; one is a scalar, more are an array. */
void hdf5_image_attribute(struct hdf5_image *image, const char *name, enum hdf5_type type,
                          const void *values, size_t count);
void hdf5_image_text(struct hdf5_image *image, const char *name, const char *text);

/* rows x columns numbers; columns = 1: an array with one index. */
void hdf5_image_data(struct hdf5_image *image, const char *name, enum hdf5_type type,
                     const void *values, size_t rows, size_t columns);

/* Writes the file unless something has failed, and frees what the image has.
 * STATUS_ENVIRONMENT: no memory, no library, or it cannot be written. */
enum status hdf5_image_end(struct hdf5_image *image, const char *path, struct error *error);
