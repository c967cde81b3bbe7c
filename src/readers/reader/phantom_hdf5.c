/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files of Phantom (Price et al. 2018): groups header and particles. */
#include <stdio.h>
#include <stdlib.h>

#include "hdf5_gas.h"
#include "phantom_gas.h"

static bool recognises(const struct snapshot_source *source)
{
    return source->file && hdf5_has(source, "header") && hdf5_has(source, "particles");
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"xyz"}, true}, {SNAPSHOT_VX, {"vxyz"}, true},
    {SNAPSHOT_U, {"u"}, false},  {SNAPSHOT_P, {"pressure"}, false},
    {SNAPSHOT_H, {"h"}, true},   {SNAPSHOT_RHO, {"density"}, false},
};

/* Reads the type of each row; NULL: all are gas. */
static enum status take_types(const struct snapshot_source *source, size_t n, double **types,
                              struct error *error)
{
    struct snapshot_file of = {.n = n};
    if (!hdf5_has(source, "particles/itype")) return STATUS_OK;
    const enum status status = hdf5_read(source, "particles/itype", &of, SNAPSHOT_M, error);
    *types = of.column[SNAPSHOT_M];
    return status;
}

static void take_header(const struct snapshot_source *source, struct phantom_header *header)
{
    static const char *const ends[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
    const int types =
        hdf5_numbers(source, "header", "massoftype", header->masses, PHANTOM_TYPES_MAX);
    header->types = types < PHANTOM_TYPES_MAX ? types : PHANTOM_TYPES_MAX;
    header->hfact = hdf5_number(source, "header", "hfact");
    header->time = hdf5_number(source, "header", "time");
    header->gamma = hdf5_number(source, "header", "gamma");
    header->boxed = true;
    for (int d = 0; d < 3; d++) {
        const struct snapshot_value lo = hdf5_number(source, "header", ends[d][0]),
                                    hi = hdf5_number(source, "header", ends[d][1]);
        header->boxed = header->boxed && lo.known && hi.known;
        header->lo[d] = lo.value, header->hi[d] = hi.value;
    }
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    (void)options;
    file->dim = 3;
    snprintf(file->code, sizeof file->code, "Phantom");
    struct phantom_header header = {0};
    double *types = NULL;
    enum status status =
        hdf5_gas(source, "particles", names, sizeof names / sizeof *names, file, error);
    if (!status) status = take_types(source, file->n, &types, error);
    if (!status) {
        take_header(source, &header);
        status = phantom_gas(source->path, &header, types, file, error);
    }
    free(types);
    return status;
}

const struct snapshot_reader reader_phantom_hdf5 = {
    {"phantom_hdf5", "HDF5 of Phantom", "Price et al. 2018"}, recognises, read};
