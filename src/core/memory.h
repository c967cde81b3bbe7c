/* SPDX-License-Identifier: GPL-3.0-or-later
 * Estimates the memory of a run before it begins. */
#ifndef SPHPROOF_MEMORY_H
#define SPHPROOF_MEMORY_H

struct setup;
struct simulation;

/* Which particle arrays a simulation needs, as a mask of enum particle_use; only scheme and plan
 * are read. */
unsigned memory_uses(const struct simulation *simulation);

/* Memory of a simulation of the setup in bytes, from its scheme, dimension and number of particles
 * (its arrays are not read); accurate to a tenth if particles are evenly spaced. */
double memory_bytes(const struct setup *setup);

#endif
