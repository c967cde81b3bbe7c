/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fortran.h"

#include <string.h>

uint64_t fortran_unsigned(const unsigned char *bytes, size_t size, bool swapped)
{
    uint64_t value = 0;
    const bool little = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;
    for (size_t k = 0; k < size; k++) {
        const size_t at = little != swapped ? size - 1 - k : k;
        value = value << 8 | bytes[at];
    }
    return value;
}

double fortran_integer(const unsigned char *bytes, size_t size, bool swapped)
{
    const uint64_t value = fortran_unsigned(bytes, size, swapped),
                   sign = (uint64_t)1 << (8 * size - 1);
    return value & sign ? -(double)(2 * sign - value) : (double)value;
}

double fortran_real(const unsigned char *bytes, size_t size, bool swapped)
{
    const uint64_t bits = fortran_unsigned(bytes, size, swapped);
    if (size == 8) {
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    const uint32_t half = (uint32_t)bits;
    float value;
    memcpy(&value, &half, sizeof value);
    return (double)value;
}

enum status fortran_next(const struct snapshot_source *source, bool swapped, size_t number,
                         size_t *at, struct fortran_record *record, struct error *error)
{
    const unsigned char *bytes = source->bytes + *at;
    const size_t left = source->size - *at;
    const size_t size = left >= 4 ? (size_t)fortran_unsigned(bytes, 4, swapped) : 0;
    if (left < 8 || size > left - 8)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: cut off: record %zu at byte %zu needs %zu bytes, %zu are left",
                         source->path, number, *at, size + 8, left);
    const size_t end = (size_t)fortran_unsigned(bytes + 4 + size, 4, swapped);
    if (end != size)
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: damaged: record %zu at byte %zu begins with %zu and ends with "
                         "%zu",
                         source->path, number, *at, size, end);
    *record = (struct fortran_record){bytes + 4, size};
    *at += size + 8;
    return STATUS_OK;
}
