/* SPDX-License-Identifier: GPL-3.0-or-later
 * A snapshot of t = 0: are its particles those of the case's initial state? What they were given
 * (positions, velocities, energies, masses) is compared with the case's gas where they are; their
 * densities are sums over neighbours, which no code reads. What differs is said in words: which
 * field, of how many particles, where, and what would explain it. */
#pragma once

#include "run.h"

enum start_field { START_VELOCITY, START_ENERGY, START_MASS, START_PRESSURE, START_FIELDS };

struct judge_start {
    bool looked; /* it is of t = 0, and of a case whose start is known */
    /* Worst difference: of velocities over the greatest, else over the value itself; of masses from
     * equal ones, or from density times a volume that is equal. NaN: not known. */
    double worst[START_FIELDS];
    size_t wrong; /* particles */
    bool explained;
    char message[500];
};

/* precision: of what the file stores beside positions. mass_ratio: all mass over the case's; NaN:
 * not known. STATUS_ENVIRONMENT: no memory. */
enum status judge_start_look(const struct run_result *result, double precision, double mass_ratio,
                             struct judge_start *start, struct error *error);
