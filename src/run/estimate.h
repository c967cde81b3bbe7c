/* SPDX-License-Identifier: GPL-3.0-or-later
 * Estimates the cost of a run before it begins. */
#pragma once

#include "simulation.h"

struct estimate {
    double memory; /* bytes, peak: initial particles, solver and final snapshot */
    double steps;
    double cpu_s; /* on a 3 GHz core; may be wrong by a factor of two */
};

/* Memory from dimension, scheme, threads and number of particles alone; steps and cpu_s are 0. */
struct estimate estimate_size(const struct setup *setup);

/* All members. Assumes that the initial signal speeds persist and that the kinetic energy of
 * colliding gas becomes heat. */
struct estimate estimate_run(const struct setup *setup);

/* STATUS_ENVIRONMENT: the estimate exceeds the memory of the machine or the limit of the
 * process. */
enum status estimate_check(const struct estimate *estimate, size_t n, struct error *error);
