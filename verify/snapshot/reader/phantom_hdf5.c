/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 as Phantom writes it (Price et al. 2018): header and particles; no density, which is m
 * (hfact/h)^d; particles of all types in the same rows, of which type 1 is gas. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf5_gas.h"

static bool recognises(const struct snapshot_source *source)
{
    return source->file && hdf5_has(source, "header") && hdf5_has(source, "particles");
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"xyz"}, true}, {SNAPSHOT_VX, {"vxyz"}, true},
    {SNAPSHOT_U, {"u"}, false},  {SNAPSHOT_P, {"pressure"}, false},
    {SNAPSHOT_H, {"h"}, true},   {SNAPSHOT_RHO, {"density"}, false},
};

/* Numbers of the header are datasets, attributes in newer files. */
static struct snapshot_value header(const struct snapshot_source *source, const char *name,
                                    struct error *error)
{
    char path[80];
    double value;
    if (hdf5_numbers(source, "header", name, &value, 1) >= 1)
        return (struct snapshot_value){true, value};
    snprintf(path, sizeof path, "header/%s", name);
    struct snapshot_file one = {.n = 1};
    size_t rows, columns;
    struct snapshot_value found = {0};
    if (hdf5_shape(source, path, &rows, &columns) && rows >= 1 && columns == 1) {
        one.n = rows;
        if (rows <= 4096 && !hdf5_read(source, path, &one, SNAPSHOT_M, error))
            found = (struct snapshot_value){true, one.column[SNAPSHOT_M][0]};
    }
    snapshot_file_free(&one);
    return found;
}

/* Rows of gas first, the others after them, each in their order. */
static enum status sort_gas(const struct snapshot_source *source, struct snapshot_file *file,
                            struct error *error)
{
    struct snapshot_file type = {.n = file->n};
    if (!hdf5_has(source, "particles/itype")) return STATUS_OK;
    enum status status = hdf5_read(source, "particles/itype", &type, SNAPSHOT_M, error);
    double *sorted = malloc((file->n + 1) * sizeof *sorted);
    if (!status && !sorted)
        status = error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
    for (int c = 0; c < SNAPSHOT_COLUMNS && !status; c++) {
        if (!file->column[c]) continue;
        size_t at = 0;
        for (int round = 0; round < 2; round++) {
            for (size_t i = 0; i < file->n; i++)
                if ((fabs(type.column[SNAPSHOT_M][i]) == 1) == !round)
                    sorted[at++] = file->column[c][i];
            if (!round) file->gas = at;
        }
        memcpy(file->column[c], sorted, file->n * sizeof *sorted);
    }
    free(sorted);
    snapshot_file_free(&type);
    return status;
}

static enum status take_header(const struct snapshot_source *source, struct snapshot_file *file,
                               struct error *error)
{
    const struct snapshot_value mass = header(source, "massoftype", error),
                                hfact = header(source, "hfact", error);
    if (!mass.known || !hfact.known || !(mass.value > 0) || !(hfact.value > 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: header/massoftype and header/hfact are needed: Phantom's density "
                         "is m (hfact/h)^3",
                         source->path);
    const bool lacks = !file->column[SNAPSHOT_RHO];
    if (!snapshot_file_make(file, SNAPSHOT_M) || (lacks && !snapshot_file_make(file, SNAPSHOT_RHO)))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
    for (size_t i = 0; i < file->n; i++) {
        file->column[SNAPSHOT_M][i] = mass.value;
        if (lacks)
            file->column[SNAPSHOT_RHO][i] =
                mass.value * pow(hfact.value / file->column[SNAPSHOT_H][i], 3);
    }
    if (lacks)
        snapshot_note(&file->notes, "density", "m (hfact/h)^3", "the file stores none; hfact = %g",
                      hfact.value);
    file->time = header(source, "time", error);
    file->gamma = header(source, "gamma", error);
    if (file->gamma.known) snapshot_note(&file->notes, "gamma", "in the file", "header/gamma");
    return STATUS_OK;
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    (void)options;
    file->parts = 1;
    file->dim = 3;
    snprintf(file->code, sizeof file->code, "Phantom");
    if (hdf5_gas(source, "particles", names, sizeof names / sizeof *names, file, error) ||
        take_header(source, file, error))
        return error->status;
    return sort_gas(source, file, error);
}

const struct snapshot_reader reader_phantom_hdf5 = {
    {"phantom_hdf5", "HDF5 of Phantom", "Price et al. 2018"}, recognises, read};
