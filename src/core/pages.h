/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory in large pages. In pages of 4 kB what is read in no order has its address looked up nearly
 * each time. */
#ifndef SPHPROOF_PAGES_H
#define SPHPROOF_PAGES_H

#include <stddef.h>

enum { PAGES_LARGE = 1 << 21 /* bytes */ };

/* Asks for large pages for what of the block lies on whole ones, where the system has them. */
void pages_ask_large(void *block, size_t bytes);

/* Bytes for free(), at a cache line, in large pages if they fill one. NULL: none left. */
void *pages_allocate(size_t bytes);

#endif
