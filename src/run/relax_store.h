/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that have been relaxed before, kept by content in the user's cache folder
 * ($XDG_CACHE_HOME/sphproof/glass, else ~/.cache/sphproof/glass; none where there is no such
 * folder), for this build of the program alone. Entries that have not been used for a month are
 * removed when others are stored. */
#ifndef SPHPROOF_RELAX_STORE_H
#define SPHPROOF_RELAX_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Numbers of points that are stored: fewer are relaxed faster than read, more fill the disk. */
enum { RELAX_STORE_LEAST = 1000, RELAX_STORE_MOST = 300000 };

/* content: a hash of all that decides where the n points end. Returns false, and leaves x alone, if
 * they are not stored. */
bool relax_store_find(uint64_t content, int dim, size_t n, double *const x[3]);

/* Stores the points. A failure is ignored: the next run relaxes them again. */
void relax_store_keep(uint64_t content, int dim, size_t n, double *const x[3]);

#endif
