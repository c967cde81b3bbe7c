/* SPDX-License-Identifier: GPL-3.0-or-later
 * Estimates the cost of a run before it begins. */
#pragma once

#include "simulation.h"

struct estimate {
    double memory; /* bytes, peak: initial particles, solver and final snapshot */
    double steps;
    double cpu_s; /* on a busy 3.7 GHz core; for these steps right within a factor of two or so */
};

/* Memory from dimension, scheme, threads and number of particles alone; steps and cpu_s are 0. */
struct estimate estimate_size(const struct setup *setup);

/* All members. Assumes that the initial smoothing lengths and signal speeds persist and that the
 * kinetic energy of colliding gas becomes heat. A run that compresses its gas, or begins with a
 * strong jump, takes more steps, up to some ten times as many (noh_1d, two_rarefactions). */
struct estimate estimate_run(const struct setup *setup);

/* STATUS_ENVIRONMENT: the estimate exceeds the memory of the machine or the limit of the
 * process. */
enum status estimate_check(const struct estimate *estimate, size_t n, struct error *error);

/* What a run refuses when it searches for neighbours: in 2D and 3D, STATUS_BAD_INPUT if an initial
 * smoothing length exceeds half a periodic side of the box. */
enum status estimate_check_reach(const struct setup *setup, struct error *error);
