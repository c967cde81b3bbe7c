/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files of SPH-EXA (Cavelan et al. 2020): groups Step#0, Step#1 ..., each with a dataset per
 * coordinate, time and gamma. h is half of the support radius. Reads the last step. */
#include <math.h>
#include <stdio.h>

#include "hdf5_gas.h"

static bool recognises(const struct snapshot_source *source)
{
    char step[40];
    return source->file && hdf5_last(source, "/", "Step#", step, sizeof step);
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"x"}, true},        {SNAPSHOT_X + 1, {"y"}, false},
    {SNAPSHOT_X + 2, {"z"}, false},   {SNAPSHOT_VX, {"vx"}, true},
    {SNAPSHOT_VX + 1, {"vy"}, false}, {SNAPSHOT_VX + 2, {"vz"}, false},
    {SNAPSHOT_M, {"m"}, false},       {SNAPSHOT_RHO, {"rho"}, true},
    {SNAPSHOT_U, {"u"}, false},       {SNAPSHOT_P, {"p"}, false},
    {SNAPSHOT_H, {"h"}, false},       {SNAPSHOT_AX, {"ax"}, false},
    {SNAPSHOT_AX + 1, {"ay"}, false}, {SNAPSHOT_AX + 2, {"az"}, false},
    {SNAPSHOT_DU, {"du"}, false},
};

/* The box is an attribute: both ends along each direction. */
static void take_box(const struct snapshot_source *source, const char *step,
                     struct snapshot_file *file)
{
    enum { ENDS = 6 };
    double box[ENDS];
    if (hdf5_numbers(source, step, "box", box, ENDS) != ENDS) return;
    file->boxed = true;
    for (int d = 0; d < 3; d++) {
        file->box[d] = box[2 * d + 1] - box[2 * d];
        file->boxed = file->boxed && file->box[d] > 0 && isfinite(file->box[d]);
    }
    for (int d = 0; d < 3 && file->boxed; d++)
        for (size_t i = 0; file->column[d] && i < file->n; i++) file->column[d][i] -= box[2 * d];
    if (file->boxed)
        snapshot_note(&file->notes, "origin", "lower corner of the box",
                      "positions are given from (%g, %g, %g), the attribute box", box[0], box[2],
                      box[4]);
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    char step[40];
    (void)options;
    hdf5_last(source, "/", "Step#", step, sizeof step);
    if (hdf5_gas(source, step, names, sizeof names / sizeof *names, file, error))
        return error->status;
    file->time = hdf5_number(source, step, "time");
    file->gamma = hdf5_number(source, step, "gamma");
    if (file->gamma.known)
        snapshot_note(&file->notes, "gamma", "in the file", "attribute %s/gamma", step);
    if (!file->column[SNAPSHOT_M]) {
        const struct snapshot_value mass = hdf5_number(source, step, "particleMass");
        if (!mass.known)
            return error_set(error, STATUS_BAD_INPUT,
                             "%.200s: no masses: neither %s/m nor its attribute particleMass",
                             source->path, step);
        if (snapshot_file_fill(file, SNAPSHOT_M, mass.value, source->path, error))
            return error->status;
    }
    take_box(source, step, file);
    snapshot_note(&file->notes, "step", step, "the last one of the file");
    snprintf(file->code, sizeof file->code, "SPH-EXA");
    return STATUS_OK;
}

const struct snapshot_reader reader_sph_exa = {
    {"sph_exa", "HDF5 of SPH-EXA", "Cavelan et al. 2020"}, recognises, read};
