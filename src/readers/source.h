/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bytes of a file that may be a snapshot; compressed text is taken apart where zlib is there.
 * HDF5 files are left to their library: only their first bytes are here. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { SOURCE_MEGABYTES_MAX = 2048 };

struct snapshot_source {
    const char *path;
    unsigned char *bytes; /* size of them and a NUL */
    size_t size;
    bool hdf5;
    void *file; /* of the HDF5 library, while its readers are at work; else NULL */
};

/* STATUS_BAD_INPUT: no such file, a directory, empty, too large. Free with source_free, also after
 * a failure. */
enum status source_open(struct snapshot_source *source, const char *path, struct error *error);
void source_free(struct snapshot_source *source);
