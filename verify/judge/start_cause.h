/* SPDX-License-Identifier: GPL-3.0-or-later
 * Particles of a start of which something is wrong: how many, where, and what would explain it. */
#ifndef SPHPROOF_START_CAUSE_H
#define SPHPROOF_START_CAUSE_H

#include "start_gas.h"

/* "a quarter". */
void start_share(size_t part, size_t n, char *text, size_t size);

/* ", at x > 1": where those are of which one of these fields is wrong. */
void start_place(const struct start_gas *gas, unsigned fields, char *text, size_t size);

/* What the wrong values of a field are; false: nothing simple. */
bool start_cause(const struct start_gas *gas, enum start_field field, char *text, size_t size);

/* Are all particles, or those that are wrong, those of other places? */
bool start_cause_places(const struct start_gas *gas, char *text, size_t size);

#endif
