/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bytes of a file that may be a snapshot. Compressed text is decompressed if zlib is available.
 * For HDF5 files only the first bytes are read; the library does the rest. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "status.h"

enum { SOURCE_MEGABYTES_MAX = 2048 };

struct snapshot_source {
    const char *path;
    unsigned char *bytes; /* size bytes and a NUL */
    size_t size;
    bool hdf5;
    void *file; /* handle of the HDF5 library while its readers run, else NULL */
};

/* STATUS_BAD_INPUT: no such file, a directory, empty, or too large. Free with source_free, also
 * after a failure. */
enum status source_open(struct snapshot_source *source, const char *path, struct error *error);
void source_free(struct snapshot_source *source);
