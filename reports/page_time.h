/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conservation through time: momentum and energy of the runs of a case against their start.
 * Internal to pages. */
#ifndef SPHPROOF_PAGE_TIME_H
#define SPHPROOF_PAGE_TIME_H

#include <jansson.h>

#include "page_plot.h"

void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count);

#endif
