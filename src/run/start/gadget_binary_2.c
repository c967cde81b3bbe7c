/* SPDX-License-Identifier: GPL-3.0-or-later
 * Format 2 of GADGET's binary files, for GADGET, AREPO and GIZMO as usually compiled: single
 * precision. These codes read the blocks up to the energies; densities and smoothing lengths are
 * for other readers. */
#include "start_format.h"

static enum status write(const struct run_result *result, const char *path, struct error *error)
{
    return gadget_binary_write(result, path, true, error);
}

static const struct snapshot_writer writer = {.write = write, .from_corner = true};

const struct start_format start_gadget_binary_2 = {
    .member = {"gadget_binary_2", "binary of GADGET, format 2: float32", "Springel 2005"},
    .writer = &writer,
    .precision = "float32: 6e-8 of each value, and of the box",
    .gamma = "GADGET-2: GAMMA in allvars.h; GADGET-4 and AREPO: GAMMA in Config.sh; GIZMO: "
             "EOS_GAMMA",
    .dimension = "GADGET-2: TWODIMS in the Makefile; GADGET-4 and AREPO: ONEDIMS or TWODIMS in "
                 "Config.sh; GIZMO: BOX_SPATIAL_DIMENSION",
    .box = "BoxSize in the parameter file, positions count from its lower corner",
    .boundary = "GADGET-2 and GADGET-4: PERIODIC; GIZMO: BOX_PERIODIC, BOX_REFLECT_X",
    .t_end = "TimeMax in the parameter file, with ICFormat 2",
};
