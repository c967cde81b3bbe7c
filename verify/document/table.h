/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small helps for tables on standard output. */
#ifndef SPHPROOF_TABLE_H
#define SPHPROOF_TABLE_H

#include "command.h"

/* Escape sequences, "" where standard output is not coloured. */
struct table_style {
    const char *bold, *faint, *good, *bad, *end;
};
struct table_style table_style(const struct options *options);

/* Prints text wrapped at 100 columns, each line after the indentation. */
void table_wrap(const char *indentation, const char *text);

#endif
