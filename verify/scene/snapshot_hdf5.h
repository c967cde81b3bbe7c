/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state at the end of a run as HDF5, laid out as GADGET's snapshots are (Springel 2005): what
 * yt, pynbody and ParaView read. Code units, double precision. */
#ifndef SPHPROOF_SNAPSHOT_HDF5_H
#define SPHPROOF_SNAPSHOT_HDF5_H

#include <stdbool.h>

#include "run.h"

/* Does the path ask for it (.hdf5 or .h5)? */
bool snapshot_hdf5_wanted(const char *path);

/* STATUS_ENVIRONMENT where the program was built without HDF5. */
enum status snapshot_hdf5_possible(const char *path, struct error *error);

/* The whole file or none. Header: NumPart_*, MassTable, Time, BoxSize (one number, or one each
 * where sides differ), Dimension, Gamma, Origin, and as text Case, Boundary and Keys
 * (see snapshot_remarks.h); PartType0: Coordinates (from the lower corner of
 * the box, `Origin`, z = 0 in 2D), Velocities, Masses, Density, InternalEnergy, Pressure,
 * SmoothingLength (support radius), ParticleIDs (from 1, in the order of the start).
 * STATUS_ENVIRONMENT: it cannot be written. */
enum status snapshot_hdf5_write(const struct run_result *result, const char *path,
                                struct error *error);

#endif
