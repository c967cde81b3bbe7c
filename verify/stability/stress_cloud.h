/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells of the stress test in 2D and 3D: every case with several schemes, relaxation of disordered
 * gas, lattices against linear theory, time steps. */
#ifndef SPHPROOF_STRESS_CLOUD_H
#define SPHPROOF_STRESS_CLOUD_H

#include "stress_cell.h"

/* A column for each built-in case in 2D and 3D, at its smallest size; what takes long by night. */
const struct stress_entry *stress_clouds(void);

/* STRESS_CLOUD: a run; measured is the share of particles whose next neighbour is nearer than half
 * a spacing. STRESS_LATTICE: growth of noise, predicted and measured. STRESS_CLOUD_STEP: the
 * largest time step, by the lattice's greatest frequency and by noise runs. */
enum status stress_cloud(const struct stress_cell *cell, json_t **document, struct error *error);

/* Of STRESS_LATTICE: a growth rate below this, in c/dx, is called none. */
extern const double stress_cloud_slowest;

#endif
