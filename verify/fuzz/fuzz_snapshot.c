/* SPDX-License-Identifier: GPL-3.0-or-later
 * Snapshots of any format: bytes that are refused, or columns of sound numbers, from which kernel
 * and meaning of h are then sought. HDF5 is read in another process, whatever becomes of it. */
#include <math.h>

#include "conventions.h"
#include "fuzz.h"
#include "snapshot_file.h"

enum { ROWS_MAX = 512 };

static void check_columns(const struct snapshot_file *file)
{
    FUZZ_PROMISE(file->dim >= 1 && file->dim <= 3 && file->gas >= 4 && file->gas <= file->n);
    FUZZ_PROMISE(file->column[SNAPSHOT_M] && file->column[SNAPSHOT_RHO]);
    for (int d = 0; d < file->dim; d++)
        FUZZ_PROMISE(file->column[d] && file->column[SNAPSHOT_VX + d]);
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++)
        for (size_t i = 0; file->column[c] && i < file->n; i++)
            FUZZ_PROMISE(isfinite(file->column[c][i]));
    for (size_t i = 0; i < file->n; i++)
        FUZZ_PROMISE(file->column[SNAPSHOT_M][i] > 0 && file->column[SNAPSHOT_RHO][i] > 0);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    const char *path = fuzz_file(bytes, size);
    const struct snapshot_options options = {.map = size % 2 ? "rho=Density" : NULL};
    struct snapshot_file file;
    struct error error = {0};
    const enum status status = snapshot_read(path, &options, &file, &error);
    if (status) {
        fuzz_refused(status, &error);
    } else {
        check_columns(&file);
        struct conventions found;
        const struct width_meaning meaning = {0};
        if (file.n <= ROWS_MAX)
            FUZZ_PROMISE(!conventions_find(&file, file.box, NULL, &meaning, &found, &error));
    }
    snapshot_file_free(&file);
}
