/* SPDX-License-Identifier: GPL-3.0-or-later
 * How much of a run the promise of sleep allows to be left out, by whatever rule. */
#ifndef SPHPROOF_BENCH_ALLOWED_H
#define SPHPROOF_BENCH_ALLOWED_H

#include "initial.h"
#include "run.h"

/* Runs it without skips. The share of particle updates after which velocity, density and internal
 * energy of the particle, and of all within a smoothing length of it, are still those of the start
 * to a tolerance, of c, rho and the energy that belongs to c: the particle's own sound speed or
 * `sound`, whichever is more. Sums differ from those of the start by what such neighbours do, so
 * anything less would leave out more than the tolerance. STATUS_*: as run_execute. */
enum status bench_allowed(const struct run *run, const struct initial *initial, double tolerance,
                          double sound, double *share, struct error *error);

#endif
