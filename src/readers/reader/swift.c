/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 files of SWIFT (Schaller et al. 2024): plural names; HydroScheme contains gamma and the
 * kernel. h is twice the standard deviation of the kernel, so that the support radius is h times
 * "Kernel gamma". */
#include <stdio.h>
#include <string.h>

#include "hdf5_gas.h"

static bool recognises(const struct snapshot_source *source)
{
    return source->file && hdf5_has(source, "Header") && hdf5_has(source, "HydroScheme");
}

static const struct hdf5_names names[] = {
    {SNAPSHOT_X, {"Coordinates"}, true},       {SNAPSHOT_VX, {"Velocities"}, true},
    {SNAPSHOT_M, {"Masses"}, false},           {SNAPSHOT_RHO, {"Densities"}, true},
    {SNAPSHOT_U, {"InternalEnergies"}, false}, {SNAPSHOT_P, {"Pressures"}, false},
    {SNAPSHOT_H, {"SmoothingLengths"}, false}, {SNAPSHOT_AX, {"Accelerations"}, false},
};

static enum status read(const struct snapshot_source *source,
                        const struct snapshot_options *options, struct snapshot_file *file,
                        struct error *error)
{
    char revision[40];
    (void)options;
    if (hdf5_gas(source, "PartType0", names, sizeof names / sizeof *names, file, error) ||
        hdf5_header(source, file, error))
        return error->status;
    file->gamma = hdf5_number(source, "HydroScheme", "Adiabatic index");
    if (file->gamma.known)
        snapshot_note(&file->notes, "gamma", "in the file",
                      "HydroScheme/Adiabatic index, in float32 %.9g", file->gamma.value);
    file->ratio = hdf5_number(source, "HydroScheme", "Kernel gamma").value;
    hdf5_text(source, "HydroScheme", "Kernel function", file->kernel, sizeof file->kernel);
    hdf5_text(source, "Code", "Git Revision", revision, sizeof revision);
    const bool known = revision[0] && strcmp(revision, "unknown") != 0;
    snprintf(file->code, sizeof file->code, "SWIFT%s%.40s", known ? " " : "",
             known ? revision : "");
    return STATUS_OK;
}

const struct snapshot_reader reader_swift = {
    {"swift", "HDF5 of SWIFT", "Schaller et al. 2024"}, recognises, read};
