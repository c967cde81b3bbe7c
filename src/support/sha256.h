/* SPDX-License-Identifier: GPL-3.0-or-later
 * SHA-256 (FIPS 180-4): results identify files by the sums that the program sha256sum prints. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SHA256_TEXT = 65 };

struct sha256 {
    uint32_t state[8];
    uint64_t bytes;
    unsigned char block[64];
};

void sha256_begin(struct sha256 *sum);
void sha256_add(struct sha256 *sum, const void *bytes, size_t n);
/* Writes 64 hexadecimal digits. */
void sha256_end(struct sha256 *sum, char text[SHA256_TEXT]);

/* The sum of a file's content; false if the file cannot be read. */
bool sha256_file(const char *path, char text[SHA256_TEXT]);
