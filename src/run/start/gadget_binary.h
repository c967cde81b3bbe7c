/* SPDX-License-Identifier: GPL-3.0-or-later
 * Binary files of GADGET (Springel 2005, user guide section 6): records enclosed by their byte
 * counts, in native byte order; single precision; positions from the lower corner of the box. The
 * codes, as usually compiled, read single precision and the blocks up to the energies; densities
 * and smoothing lengths are for other readers. */
#pragma once

#include "start_format.h"

/* named: format 2, in which a record before each block names the block; else format 1.
 * STATUS_BAD_INPUT: too many particles for a record; STATUS_ENVIRONMENT: no memory, or the file
 * cannot be written. */
enum status gadget_binary_write(const struct run_result *result, const char *path, bool named,
                                struct error *error);

/* Defines one of the two formats. */
#define GADGET_BINARY(name, number, named)                                                         \
    static enum status write(const struct run_result *result, const char *path,                    \
                             struct error *error)                                                  \
    {                                                                                              \
        return gadget_binary_write(result, path, named, error);                                    \
    }                                                                                              \
    static const struct snapshot_writer writer = {.write = write, .from_corner = true};            \
    const struct start_format start_##name = {                                                     \
        .member = {#name, "binary of GADGET, format " number ": float32", "Springel 2005"},        \
        .writer = &writer,                                                                         \
        .precision = "float32: 6e-8 of each value, and of the box",                                \
        .gamma = "GADGET-2: GAMMA in allvars.h; GADGET-4 and AREPO: GAMMA in Config.sh; GIZMO: "   \
                 "EOS_GAMMA",                                                                      \
        .dimension = "GADGET-2: TWODIMS in the Makefile; GADGET-4 and AREPO: ONEDIMS or TWODIMS "  \
                     "in Config.sh; GIZMO: BOX_SPATIAL_DIMENSION",                                 \
        .box = "BoxSize in the parameter file, positions count from its lower corner",             \
        .boundary = "GADGET-2 and GADGET-4: PERIODIC; GIZMO: BOX_PERIODIC, BOX_REFLECT_X",         \
        .t_end = "TimeMax in the parameter file, with ICFormat " number,                           \
    }
