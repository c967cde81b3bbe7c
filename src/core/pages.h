/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory in large pages. With pages of 4 kB nearly every random access needs an address
 * translation. */
#ifndef SPHPROOF_PAGES_H
#define SPHPROOF_PAGES_H

#include <stddef.h>

enum { PAGES_LARGE = 1 << 21 /* bytes */ };

/* Requests large pages for the part of the block that fills whole ones, if the system has them. */
void pages_ask_large(void *block, size_t bytes);

/* Allocates memory aligned to a cache line, in large pages if it fills one; release with free().
 * NULL: no memory. */
void *pages_allocate(size_t bytes);

#endif
