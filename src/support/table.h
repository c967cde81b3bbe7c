/* SPDX-License-Identifier: GPL-3.0-or-later
 * Utilities for tables on standard output. */
#pragma once

#include <stdbool.h>

/* Escape sequences, "" without colour. */
struct table_style {
    const char *bold, *faint, *good, *bad, *end;
};
struct table_style table_style(bool color);

/* Prints text wrapped at 100 columns, each line after the indentation. */
void table_wrap(const char *indentation, const char *text);
