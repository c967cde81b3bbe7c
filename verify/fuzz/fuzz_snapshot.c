/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes snapshots of any format: GADGET and Phantom binaries, SPLASH's ASCII, tables. HDF5, which
 * is read in another process, takes far longer: only one size in 512 is read here, fuzz_hdf5.c and
 * fuzz_damage.c test the rest. */
#include <string.h>

#include "fuzz.h"
#include "fuzz_read.h"

/* The signature may follow a user block. */
static bool is_hdf5(const uint8_t *bytes, size_t size)
{
    for (size_t at = 0; at + 4 <= size; at = at ? 2 * at : 512)
        if (memcmp(bytes + at, "\x89HDF", 4) == 0) return true;
    return false;
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const struct snapshot_options options = {.map = size % 2 ? "rho=Density" : NULL};
    if (size % 512 == 0 || !is_hdf5(bytes, size))
        fuzz_read(fuzz_file(bytes, size), &options, size % 32 == 0);
}
