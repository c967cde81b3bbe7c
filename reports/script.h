/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gnuplot script and the data of a plot, and what makes its SVG fit into a page. Internal to
 * plots. */
#pragma once

#include "buffer.h"
#include "plot.h"

enum script_terminal { SCRIPT_SVG, SCRIPT_PNG };

/* The data: one block a series, two blank lines between, as gnuplot's `index` counts them. */
void script_data(struct buffer *to, const struct plot *plot);

/* The script. output: file it writes, NULL for standard output; data: the file it reads, in
 * quotes; NULL: the data stand in the script. */
void script_make(struct buffer *to, const struct plot *plot, enum script_terminal terminal,
                 const char *output, const char *data);

/* Appends raw as an <svg class="plot"> element: prolog, filters and empty groups dropped; ids and
 * references to them prefixed; colours of the style replaced by currentColor with a class (the
 * colour itself stays as a fallback where no style sheet is); title (escaped here) for readers who
 * cannot see it. False: raw is not an SVG document. */
bool svg_adapt(struct buffer *to, const char *raw, const char *prefix, const char *title);
