/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the installed files of an installed program: relative to the program, so that the whole
 * tree may be moved; otherwise at the configured place. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { PLACE_LENGTH = 4096 };

/* The path of an installed file or folder, such as "cases/sod.ini" or "sphproof-1.schema.json".
 * False, with path = "": it does not exist (for example if the program is not installed). */
bool place_find(const char *name, char path[PLACE_LENGTH]);
