/* SPDX-License-Identifier: GPL-3.0-or-later
 * Plot of an autopsy: how each share of the error decreases, a bar of shares for each number of
 * particles, and the conclusion. */
#pragma once

#include <jansson.h>

#include "page_plot.h"
#include "status.h"

/* document: of `sphproof autopsy`. Returns as picture_write. */
enum status autopsy_plot_write(const json_t *document, const char *path, struct error *error);

/* The same as a figure of a page, with this name. */
void autopsy_plot_page(struct page_writer *writer, const json_t *document, const char *name);
