/* SPDX-License-Identifier: GPL-3.0-or-later
 * Noise runs: does a lattice at rest, disturbed a little, stay as it is? */
#ifndef SPHPROOF_STRESS_NOISE_H
#define SPHPROOF_STRESS_NOISE_H

#include "run.h"

/* Sets a number of the settings, as a user's key would. */
void stress_noise_set(struct run_settings *settings, enum setting key, double value);

/* Root mean square speed over the sound speed after `time` spacings/c in gas of density and
 * pressure 1 in a box of size 1; INFINITY where it broke down, which noise that grows does in the
 * end. */
double stress_noise_after(struct run_settings settings, double time);

/* Has it doubled by then? */
bool stress_noise_grows(const struct run_settings *settings, double time);

#endif
