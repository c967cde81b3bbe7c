/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fuzz_read.h"

#include <math.h>

#include "conventions.h"
#include "fuzz.h"

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

enum status fuzz_read(const char *path, const struct snapshot_options *options, bool seek)
{
    struct snapshot_file file;
    struct error error = {0};
    const enum status status = snapshot_read(path, options, &file, &error);
    if (status) {
        fuzz_refused(status, &error);
    } else {
        check_columns(&file);
        struct conventions found;
        const struct width_meaning meaning = {0};
        if (seek && file.n <= ROWS_MAX)
            FUZZ_PROMISE(!conventions_find(&file, file.box, NULL, &meaning, &found, &error));
    }
    snapshot_file_free(&file);
    return status;
}
