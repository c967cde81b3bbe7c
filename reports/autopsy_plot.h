/* SPDX-License-Identifier: GPL-3.0-or-later
 * The picture of an autopsy: how each share of an error falls, a bar of shares for each number of
 * particles, and the sentence. */
#pragma once

#include <jansson.h>

#include "page_plot.h"
#include "status.h"

/* document: of `sphproof autopsy`. STATUS_*: as picture_write. */
enum status autopsy_plot_write(const json_t *document, const char *path, struct error *error);

/* The same as a figure of a page, called name there. */
void autopsy_plot_page(struct page_writer *writer, const json_t *document, const char *name);
