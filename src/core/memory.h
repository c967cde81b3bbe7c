/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run will ask for, said before it begins. */
#ifndef SPHPROOF_MEMORY_H
#define SPHPROOF_MEMORY_H

struct setup;
struct simulation;

/* What a simulation, of which scheme and plan are known, has use for: of enum particle_use. */
unsigned memory_uses(const struct simulation *simulation);

/* Bytes that a simulation of the setup comes to use, by its scheme, dimension and number of
 * particles (no array of it is read): within a tenth where particles are evenly spaced. */
double memory_bytes(const struct setup *setup);

#endif
