/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 as Phantom writes it (Price et al. 2018): header and particles; no density, which is m
 * (hfact/h)^d; particles of all types in the same rows, of which type 1 is gas. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hdf5_gas.h"

enum { GAS = 1, TYPES_MAX = 32 };

static bool recognises(const struct snapshot_source *source)
{
    return source->file && hdf5_has(source, "header") && hdf5_has(source, "particles");
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"xyz"}, true}, {SNAPSHOT_VX, {"vxyz"}, true},
    {SNAPSHOT_U, {"u"}, false},  {SNAPSHOT_P, {"pressure"}, false},
    {SNAPSHOT_H, {"h"}, true},   {SNAPSHOT_RHO, {"density"}, false},
};

/* Type of each row, as a positive number; NULL: all are gas, or there is no memory. Phantom turns
 * the sign of particles that are between their time steps. */
static enum status take_types(const struct snapshot_source *source, struct snapshot_file *file,
                              double **types, struct error *error)
{
    struct snapshot_file of = {.n = file->n};
    *types = NULL;
    if (!hdf5_has(source, "particles/itype")) return STATUS_OK;
    const enum status status = hdf5_read(source, "particles/itype", &of, SNAPSHOT_M, error);
    for (size_t i = 0; i < file->n && !status; i++)
        of.column[SNAPSHOT_M][i] = fabs(of.column[SNAPSHOT_M][i]);
    if (status)
        snapshot_file_free(&of);
    else
        *types = of.column[SNAPSHOT_M];
    return status;
}

/* Rows of gas first, the others after them, each in their order. */
static enum status sort_gas(struct snapshot_file *file, const double *types, const char *path,
                            struct error *error)
{
    if (!types) return STATUS_OK;
    double *sorted = malloc((file->n + 1) * sizeof *sorted);
    if (!sorted) return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", path);
    for (int c = 0; c < SNAPSHOT_COLUMNS; c++) {
        if (!file->column[c]) continue;
        size_t at = 0;
        for (int round = 0; round < 2; round++) {
            for (size_t i = 0; i < file->n; i++)
                if ((types[i] == GAS) == !round) sorted[at++] = file->column[c][i];
            if (!round) file->gas = at;
        }
        memcpy(file->column[c], sorted, file->n * sizeof *sorted);
    }
    free(sorted);
    return STATUS_OK;
}

/* Masses, one for each type, and the density that follows from them and h. */
static enum status take_masses(const struct snapshot_source *source, struct snapshot_file *file,
                               const double *types, struct error *error)
{
    double masses[TYPES_MAX] = {0}, hfact = 0;
    const int count = hdf5_numbers(source, "header", "massoftype", masses, TYPES_MAX),
              said = hdf5_numbers(source, "header", "hfact", &hfact, 1);
    if (count < 1 || !(masses[0] > 0) || said < 1 || !(hfact > 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "%.200s: Phantom's density is m (hfact/h)^3: header/massoftype %s %g, "
                         "header/hfact %s %g; allowed: numbers above 0",
                         source->path, count < 1 ? "is no number, read as" : "begins with",
                         masses[0], said < 1 ? "is no number, read as" : "is", hfact);
    const bool lacks = !file->column[SNAPSHOT_RHO];
    if (!snapshot_file_make(file, SNAPSHOT_M) || (lacks && !snapshot_file_make(file, SNAPSHOT_RHO)))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %.200s", source->path);
    for (size_t i = 0; i < file->n; i++) {
        const double type = types ? types[i] : GAS;
        const double m = type >= 1 && type <= fmin(count, TYPES_MAX) ? masses[(int)type - 1] : 0;
        file->column[SNAPSHOT_M][i] = m > 0 ? m : masses[0];
        if (lacks)
            file->column[SNAPSHOT_RHO][i] =
                file->column[SNAPSHOT_M][i] * pow(hfact / file->column[SNAPSHOT_H][i], 3);
    }
    if (lacks)
        snapshot_note(&file->notes, "density", "m (hfact/h)^3", "the file stores none; hfact = %g",
                      hfact);
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
    double *types = NULL;
    static const char *const times[] = {"header:time", NULL}, *const gammas[] = {"header:gamma",
                                                                                 NULL};
    if (hdf5_gas(source, "particles", names, sizeof names / sizeof *names, file, error) ||
        take_types(source, file, &types, error))
        return error->status;
    file->time = hdf5_first(source, times, NULL);
    file->gamma = hdf5_first(source, gammas, NULL);
    if (file->gamma.known) snapshot_note(&file->notes, "gamma", "in the file", "header/gamma");
    enum status status = take_masses(source, file, types, error);
    if (!status) status = sort_gas(file, types, source->path, error);
    free(types);
    return status;
}

const struct snapshot_reader reader_phantom_hdf5 = {
    {"phantom_hdf5", "HDF5 of Phantom", "Price et al. 2018"}, recognises, read};
