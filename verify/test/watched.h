/* SPDX-License-Identifier: GPL-3.0-or-later
 * An allocator that finds faults: the linker's --wrap redirects all allocations of the project to
 * it (meson.build). It fills new memory with NaN, overwrites memory before freeing it, fences both
 * ends of every block, and counts damaged fences when blocks are freed. It counts calls and can
 * refuse them. For one test file; memory that a library has allocated must not be freed here. */
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

enum { WATCHED_FENCE = 128 }; /* bytes on either side; the first ones hold the size */

static atomic_long watched_calls;               /* calls for memory */
static atomic_long watched_refuse;              /* the number of the call that fails; 0: none */
static atomic_long watched_live;                /* blocks that are not freed */
static atomic_size_t watched_now, watched_most; /* bytes in use, and their maximum */
static atomic_long watched_broken;              /* blocks with overwritten fences */

void *__real_malloc(size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

static size_t watched_size(const void *memory)
{
    size_t size;
    memcpy(&size, (const char *)memory - WATCHED_FENCE, sizeof size);
    return size;
}

static void *watched_take(size_t size)
{
    if (++watched_calls == watched_refuse) return NULL;
    const size_t whole = (size + 3 * WATCHED_FENCE - 1) / WATCHED_FENCE * WATCHED_FENCE;
    unsigned char *block = __real_aligned_alloc(WATCHED_FENCE, whole);
    if (!block) return NULL;
    memset(block, 0xa5, whole);
    memset(block + WATCHED_FENCE, 0xff, size);
    memcpy(block, &size, sizeof size);
    watched_live++;
    watched_now += size;
    if (watched_now > watched_most) watched_most = watched_now;
    return block + WATCHED_FENCE;
}

void *__wrap_malloc(size_t size)
{
    return watched_take(size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    if (alignment > WATCHED_FENCE || size % alignment) watched_broken++;
    return watched_take(size);
}

void *__wrap_calloc(size_t n, size_t size)
{
    void *memory = watched_take(n * size);
    return memory ? memset(memory, 0, n * size) : NULL;
}

void __wrap_free(void *memory)
{
    if (!memory) return;
    const size_t size = watched_size(memory);
    const unsigned char *block = (unsigned char *)memory - WATCHED_FENCE;
    bool whole = true;
    for (size_t k = sizeof size; k < WATCHED_FENCE; k++) whole &= block[k] == 0xa5;
    for (size_t k = 0; k < WATCHED_FENCE; k++) whole &= block[WATCHED_FENCE + size + k] == 0xa5;
    watched_broken += !whole;
    watched_live--;
    watched_now -= size;
    memset((void *)(uintptr_t)block, 0xee, size + 2 * WATCHED_FENCE);
    __real_free((void *)(uintptr_t)block);
}

void *__wrap_realloc(void *memory, size_t size)
{
    void *larger = watched_take(size);
    if (!larger || !memory) return larger;
    const size_t old = watched_size(memory);
    memcpy(larger, memory, old < size ? old : size);
    __wrap_free(memory);
    return larger;
}

/* Resets the counts; call number `refuse` will fail. */
static void watched_begin(long refuse)
{
    watched_calls = watched_live = watched_broken = 0;
    watched_now = watched_most = 0;
    watched_refuse = refuse;
}
