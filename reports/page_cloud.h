/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs in 2D and 3D: maps, particles over the exact curve, errors, conservation and scalars.
 * Internal to pages. */
#ifndef SPHPROOF_PAGE_CLOUD_H
#define SPHPROOF_PAGE_CLOUD_H

#include <jansson.h>

#include "page_plot.h"

/* Pictures of the runs (run documents) of one case: maps of the first run, maps of all errors on
 * one colour scale (of all densities where there is no exact solution), and all runs over the exact
 * curve. all_maps: every map of every run, on common colour scales, in place of those of the first
 * run. The element <div class="figures"> is left open, so that the caller can add figures. */
void page_cloud_plots(struct page_writer *writer, const char *case_name, const json_t *const *runs,
                      size_t count, bool all_maps);

/* Errors, conservation and cost, and scalars beside their exact values. */
void page_cloud_tables(struct buffer *to, const json_t *const *runs, size_t count);

#endif
