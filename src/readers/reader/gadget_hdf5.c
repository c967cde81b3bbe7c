/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files of GADGET-2 to -4, AREPO and GIZMO (Springel 2005, user guide): PartType0, singular
 * names, no gamma. */
#include <stdio.h>

#include "hdf5_gas.h"

static bool recognises(const struct snapshot_source *source)
{
    return source->file && hdf5_has(source, "Header"); /* SWIFT's reader is asked before */
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"Coordinates"}, true},
    {SNAPSHOT_VX, {"Velocities"}, true},
    {SNAPSHOT_M, {"Masses"}, false},
    {SNAPSHOT_RHO, {"Density"}, true},
    {SNAPSHOT_U, {"InternalEnergy"}, false},
    {SNAPSHOT_P, {"Pressure"}, false},
    {SNAPSHOT_H, {"SmoothingLength", "Hsml"}, false},
    {SNAPSHOT_AX, {"Acceleration", "HydroAcceleration"}, false},
    {SNAPSHOT_DU, {"RateOfChangeOfInternalEnergy"}, false},
};

/* Our own snapshots name their case and give the lower corner of the box, to which positions in the
 * file are relative. */
static void place(const struct snapshot_source *source, struct snapshot_file *file)
{
    enum { DIRECTIONS = 3 };
    double corner[DIRECTIONS];
    hdf5_text(source, "Header", "Case", file->case_name, sizeof file->case_name);
    hdf5_text(source, "Header", "Boundary", file->boundary, sizeof file->boundary);
    hdf5_text(source, "Header", "Keys", file->keys, sizeof file->keys);
    if (!file->boxed || hdf5_numbers(source, "Header", "Origin", corner, DIRECTIONS) != DIRECTIONS)
        return;
    file->placed = true;
    for (int d = 0; d < DIRECTIONS && file->column[d]; d++) {
        file->corner[d] = corner[d];
        for (size_t i = 0; i < file->n; i++) file->column[d][i] += corner[d];
    }
}

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    static const char *const gammas[] = {"Header:Gamma", "Header:gamma", "Parameters:Gamma",
                                         "Config:GAMMA", NULL};
    (void)options;
    if (hdf5_gas(source, "PartType0", names, sizeof names / sizeof *names, file, error) ||
        hdf5_header(source, file, error))
        return error->status;
    const struct snapshot_value version = hdf5_number(source, "Header", "GIZMO_version");
    const char *from = "";
    place(source, file);
    file->gamma = hdf5_first(source, gammas, &from);
    if (file->gamma.known)
        snapshot_note(&file->notes, "gamma", "in the file", "attribute %s", from);
    if (version.known)
        snprintf(file->code, sizeof file->code, "GIZMO %g", version.value);
    else
        snprintf(file->code, sizeof file->code, "%s",
                 hdf5_has(source, "Config") ? "AREPO or GADGET-4" : "GADGET or its kin");
    return STATUS_OK;
}

const struct snapshot_reader reader_gadget_hdf5 = {
    {"gadget_hdf5", "HDF5 of GADGET, AREPO and GIZMO", "Springel 2005"}, recognises, read};
