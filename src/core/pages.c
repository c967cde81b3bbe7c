/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pages.h"

#include <stdint.h>
#include <stdlib.h>
#include <sys/mman.h>

void pages_ask_large(void *block, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    const uintptr_t page = PAGES_LARGE, first = ((uintptr_t)block + page - 1) / page * page,
                    end = ((uintptr_t)block + bytes) / page * page;
    if (first < end) (void)madvise((void *)first, end - first, MADV_HUGEPAGE);
#else
    (void)block, (void)bytes;
#endif
}

void *pages_allocate(size_t bytes)
{
    const size_t line = 64, at = bytes < PAGES_LARGE ? line : PAGES_LARGE;
    void *block = aligned_alloc(at, (bytes + at - 1) / at * at);
    if (block) pages_ask_large(block, bytes);
    return block;
}
