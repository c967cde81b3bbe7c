/* SPDX-License-Identifier: GPL-3.0-or-later
 * Makes gnuplot's SVG fit into a page. Internal to plots. */
#ifndef SPHPROOF_SVG_H
#define SPHPROOF_SVG_H

#include "buffer.h"

/* Appends raw as an <svg class="plot"> element: prolog, filters and empty groups dropped; ids and
 * references to them prefixed; colours of the style replaced by currentColor with a class (the
 * colour itself stays as a fallback where no style sheet is); title (escaped here) for readers who
 * cannot see it. False: raw is not an SVG document. */
bool svg_adapt(struct buffer *to, const char *raw, const char *prefix, const char *title);

#endif
