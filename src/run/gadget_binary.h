/* SPDX-License-Identifier: GPL-3.0-or-later
 * Binaries of GADGET (Springel 2005, user guide section 6): records between two counts of their
 * bytes, in this machine's order; numbers in single precision, positions from the lower corner of
 * the box. */
#ifndef SPHPROOF_GADGET_BINARY_H
#define SPHPROOF_GADGET_BINARY_H

#include <stdbool.h>

#include "run.h"

/* named: format 2, in which a record before each block names it; else format 1.
 * STATUS_BAD_INPUT: more particles than a record can count; STATUS_ENVIRONMENT: no memory, or it
 * cannot be written. */
enum status gadget_binary_write(const struct run_result *result, const char *path, bool named,
                                struct error *error);

#endif
