/* SPDX-License-Identifier: GPL-3.0-or-later
 * Levels of a study out of the documents of its runs. */
#ifndef SPHPROOF_STUDY_READ_H
#define SPHPROOF_STUDY_READ_H

#include "study.h"

/* Those of combination c, in order, up to the first that broke down: result->status says so.
 * STATUS_ENVIRONMENT and others: a run is missing. */
enum status study_read_levels(struct study *study, size_t c, const struct pool *pool,
                              struct error *error);

#endif
