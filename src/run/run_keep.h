/* SPDX-License-Identifier: GPL-3.0-or-later
 * The state that a result keeps, in an order that does not depend on how the solver sorts
 * particles.
 */
#ifndef SPHPROOF_RUN_KEEP_H
#define SPHPROOF_RUN_KEEP_H

#include "run.h"

/* Copies a snapshot, which may be the solver's own memory, into result->snapshot: in 1D by
 * position, in 2D and 3D by number. Sets the time, the spacing, and how many neighbours have
 * crossed. run_free it. STATUS_ENVIRONMENT: no memory. */
enum status run_keep(struct run_result *result, const struct snapshot *snapshot,
                     struct error *error);

#endif
