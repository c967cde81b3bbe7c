/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shock tubes drawn at random, the same ones every time: columns of a map. */
#ifndef SPHPROOF_STRESS_TUBES_H
#define SPHPROOF_STRESS_TUBES_H

#include "stress_cell.h"

/* Entries of the case sod (ratios of density to 1e3, of pressure to 1e5), most of them for the
 * night, ending with a NULL label; they live as long as the program. Not for two threads at once.
 */
const struct stress_entry *stress_tubes(void);

#endif
