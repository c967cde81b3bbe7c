/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run will ask for, said before it begins; and large pages. */
#ifndef SPHPROOF_MEMORY_H
#define SPHPROOF_MEMORY_H

#include <stddef.h>

struct setup;
struct simulation;

/* What a simulation, of which scheme and plan are known, has use for: of enum particle_use. */
unsigned memory_uses(const struct simulation *simulation);

/* Bytes that a simulation of the setup comes to use, by its scheme, dimension and number of
 * particles (no array of it is read): within a tenth where particles are evenly spaced. */
double memory_bytes(const struct setup *setup);

/* Asks for large pages for what of the block lies on whole ones, where the system has them. */
enum { MEMORY_LARGE_PAGE = 1 << 21 /* bytes */ };
void memory_ask_for_large_pages(void *block, size_t bytes);

/* Bytes for free(), at a cache line, that are read in no order: addresses of small pages would have
 * to be looked up nearly each time. NULL: none left. */
void *memory_for_records(size_t bytes);

#endif
