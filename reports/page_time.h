/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs of a case through time: momentum, angular momentum and energy against their start; how
 * regular their particles stand. Internal to pages. */
#ifndef SPHPROOF_PAGE_TIME_H
#define SPHPROOF_PAGE_TIME_H

#include <jansson.h>

#include "page_plot.h"

void page_time(struct page_writer *writer, const char *case_name, const json_t *const *runs,
               size_t count);

#endif
