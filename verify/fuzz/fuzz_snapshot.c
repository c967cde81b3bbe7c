/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots of any format, as the bytes are: binaries of GADGET, ASCII of SPLASH, tables. HDF5 is
 * left to fuzz_hdf5.c and fuzz_damage.c. */
#include <string.h>

#include "fuzz.h"
#include "fuzz_read.h"

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const struct snapshot_options options = {.map = size % 2 ? "rho=Density" : NULL};
    if (size < 4 || memcmp(bytes, "\x89HDF", 4) != 0)
        fuzz_read(fuzz_file(bytes, size), &options, size % 32 == 0);
}
