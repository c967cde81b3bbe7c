/* SPDX-License-Identifier: GPL-3.0-or-later
 * A snapshot of t = 0: compares positions, velocities, energies and masses with the case's initial
 * state (densities are sums over neighbours, which no code reads). Describes differences in words:
 * which field, of how many particles, where, and what would explain them. */
#pragma once

#include "run.h"

enum start_field { START_VELOCITY, START_ENERGY, START_MASS, START_PRESSURE, START_FIELDS };

struct judge_start {
    bool looked; /* the snapshot is of t = 0, and the case has a known start */
    /* Worst relative difference: of velocities over the greatest speed, of other fields over the
     * exact value; of masses from equal masses, or from density times an equal volume. NaN:
     * unknown. */
    double worst[START_FIELDS];
    size_t wrong; /* number of particles with a wrong value */
    bool explained;
    bool moved; /* none is wrong, but some have the state of another position, a spacing away */
    char message[500];
};

/* precision: relative rounding of what the file stores besides positions. mass_ratio: total mass
 * over the case's; NaN: unknown. STATUS_ENVIRONMENT: no memory. */
enum status judge_start_look(const struct run_result *result, double precision, double mass_ratio,
                             struct judge_start *start, struct error *error);
