/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gnuplot script and data of a plot, and the conversion of its SVG for a page. Internal to
 * plots. */
#pragma once

#include "buffer.h"
#include "plot.h"

enum script_terminal { SCRIPT_SVG, SCRIPT_PNG };

/* The data: one block per series, separated by two blank lines, as counted by gnuplot's `index`. */
void script_data(struct buffer *to, const struct plot *plot);

/* The script. output: file that it writes, NULL for standard output; data: file that it reads,
 * quoted; NULL: the script contains the data. */
void script_make(struct buffer *to, const struct plot *plot, enum script_terminal terminal,
                 const char *output, const char *data);

/* Appends raw as an <svg class="plot"> element: drops prolog, filters and empty groups; prefixes
 * ids and references to them; replaces colours of the style by currentColor with a class (the
 * colour itself is kept as a fallback without a style sheet); adds the title (escaped here) as a
 * text alternative. False: raw is not an SVG document. */
bool svg_adapt(struct buffer *to, const char *raw, const char *prefix, const char *title);
