/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs in 2D and 3D: maps, particles over the exact curve, errors, conservation and scalars.
 * Internal to pages. */
#ifndef SPHPROOF_PAGE_CLOUD_H
#define SPHPROOF_PAGE_CLOUD_H

#include <jansson.h>

#include "page_plot.h"

/* Ends within an open <div class="figures">, for what else there is to show beside the last one.
 * Pictures of the runs (run documents) of one case: the first one's maps, the errors of all (the
 * densities, where nothing is exact) on one colour scale, and all of them over the exact curve.
 * all_maps: every map of all runs on one colour scale, in place of the first one's. */
void page_cloud_plots(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      size_t count, bool all_maps);

/* Errors, conservation and cost; scalars beside what they should be. */
void page_cloud_tables(struct buffer *to, const json_t *const *runs, size_t count);

#endif
