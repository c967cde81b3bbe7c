/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where an installed program finds what was installed with it: relative to itself, so that the
 * whole tree may be moved; else at the place it was configured for. */
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { PLACE_LENGTH = 4096 };

/* The path of an installed file or folder, such as "cases/sod.ini" or "sphproof-1.schema.json".
 * False: it is not there (a program that was only built has none), path is then "". */
bool place_find(const char *name, char path[PLACE_LENGTH]);
