/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a reader of Fortran records must say of a file that ends early. */
#pragma once

#include <stdbool.h>
#include <stdio.h>

/* Writes the message about the first record that the `size` bytes do not hold; "" if they hold all.
 * The test's machines are little-endian. */
static inline void say_cut(const unsigned char *bytes, size_t size, bool swapped, char says[120])
{
    size_t at = 0, number = 1;
    for (says[0] = '\0'; at < size; number++) {
        const size_t left = size - at;
        size_t count = 0;
        for (size_t k = 0; k < 4 && left >= 4; k++)
            count = count << 8 | bytes[at + (swapped ? k : 3 - k)];
        if (left < 8 || count > left - 8) {
            snprintf(says, 120, "cut off: record %zu at byte %zu needs %zu bytes, %zu are left",
                     number, at, count + 8, left);
            return;
        }
        at += count + 8;
    }
}
