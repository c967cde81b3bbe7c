/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that have been relaxed before, kept by content in the user's cache folder
 * ($XDG_CACHE_HOME/sphproof/glass, else ~/.cache/sphproof/glass; none where there is no such
 * place), for this build of the program alone. What nobody has used for a month is removed when
 * others are kept. */
#ifndef SPHPROOF_RELAX_STORE_H
#define SPHPROOF_RELAX_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Fewer are relaxed before they are read; more take too much of a disk. */
enum { RELAX_STORE_LEAST = 1000, RELAX_STORE_MOST = 300000 };

/* content: a hash of all that decides where the n points end. False, and x untouched: not kept. */
bool relax_store_find(uint64_t content, int dim, size_t n, double *const x[3]);

/* Does what it can. */
void relax_store_keep(uint64_t content, int dim, size_t n, double *const x[3]);

#endif
