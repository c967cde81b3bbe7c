/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run will take, said before it begins. */
#pragma once

#include "simulation.h"

struct estimate {
    double memory; /* bytes, the most at any time: particles at the start, solver, snapshot at the
                      end */
    double steps;
    double cpu_s; /* on a core of about 3 GHz: half of it or twice as much are no surprise */
};

/* By dimension, scheme, threads and number of particles alone; steps and cpu_s are 0. */
struct estimate estimate_size(const struct setup *setup);

/* All of it; the first signals are thought to stay, and where gas meets gas its motion to become
 * heat. */
struct estimate estimate_run(const struct setup *setup);

/* STATUS_ENVIRONMENT: it is more than this machine has, or this process may have. */
enum status estimate_check(const struct estimate *estimate, size_t n, struct error *error);
