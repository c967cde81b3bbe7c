/* SPDX-License-Identifier: GPL-3.0-or-later
 * The error message of a run that breaks down. */
#ifndef SPHPROOF_BREAKDOWN_H
#define SPHPROOF_BREAKDOWN_H

#include <stddef.h>

#include "status.h"

struct simulation;

/* Reports a breakdown at particle i, quantity = value, at the current time. Returns
 * STATUS_BROKE_DOWN. */
enum status breakdown_of(const struct simulation *simulation, ptrdiff_t i, const char *quantity,
                         double value, struct error *error);

#endif
