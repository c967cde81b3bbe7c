/* SPDX-License-Identifier: GPL-3.0-or-later
 * The gnuplot script and the data of a plot. Internal to plots. */
#ifndef SPHPROOF_SCRIPT_H
#define SPHPROOF_SCRIPT_H

#include "plot.h"
#include "buffer.h"

enum script_terminal { SCRIPT_SVG, SCRIPT_PNG };

/* The data: one block a series, two blank lines between, as gnuplot's `index` counts them. */
void script_data(struct buffer *to, const struct plot *plot);

/* The script. output: file it writes, NULL for standard output; data: the file it reads, in
 * quotes; NULL: the data stand in the script. */
void script_make(struct buffer *to, const struct plot *plot, enum script_terminal terminal,
                 const char *output, const char *data);

#endif
