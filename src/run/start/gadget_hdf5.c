/* SPDX-License-Identifier: GPL-3.0-or-later
 * HDF5 for GADGET-4, AREPO and GIZMO: double precision, positions from the lower corner of the box,
 * InternalEnergy is u. */
#include "start_format.h"

extern const struct snapshot_writer writer_gadget_hdf5;

const struct start_format start_gadget_hdf5 = {
    .member = {"gadget_hdf5", "HDF5 for GADGET-4, AREPO and GIZMO", "Springel 2005"},
    .writer = &writer_gadget_hdf5,
    .gamma = "GADGET-4 and AREPO: GAMMA in Config.sh; GIZMO: EOS_GAMMA in Config.sh",
    .dimension = "GADGET-4: ONEDIMS or TWODIMS, AREPO: ONEDIMS or TWODIMS, GIZMO: "
                 "BOX_SPATIAL_DIMENSION in Config.sh",
    .box =
        "BoxSize in the parameter file, positions count from its lower corner; sides that "
        "differ, in Config.sh: GADGET-4 LONG_X_BITS (BoxSize over a power of two), AREPO LONG_X, "
        "GIZMO BOX_LONG_X (times BoxSize)",
    .boundary = "Config.sh: GADGET-4 PERIODIC (it has no walls); AREPO REFLECTIVE_X=1 for walls, 2 "
                "for open ends; GIZMO BOX_PERIODIC, BOX_REFLECT_X",
    .t_end = "TimeMax in the parameter file",
    .precision = "float64, for which AREPO and GIZMO need INPUT_IN_DOUBLEPRECISION in Config.sh",
};
