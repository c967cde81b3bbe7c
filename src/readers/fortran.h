/* SPDX-License-Identifier: GPL-3.0-or-later
 * Unformatted Fortran files: records enclosed by their byte counts, with numbers in either byte
 * order. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "source.h"

struct fortran_record {
    const unsigned char *bytes;
    size_t size;
};

/* swapped: opposite to native byte order. size: 1, 2, 4 or 8 bytes; for a real 4 or 8. */
uint64_t fortran_unsigned(const unsigned char *bytes, size_t size, bool swapped);
double fortran_integer(const unsigned char *bytes, size_t size, bool swapped);
double fortran_real(const unsigned char *bytes, size_t size, bool swapped);

/* Reads the record at *at and advances *at past it; number: for messages, from 1. STATUS_BAD_INPUT:
 * the file is truncated, or the counts differ. */
enum status fortran_next(const struct snapshot_source *source, bool swapped, size_t number,
                         size_t *at, struct fortran_record *record, struct error *error);
