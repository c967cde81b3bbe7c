/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results kept by content: an entry belongs to a key (all that decides a result: case and settings)
 * and to this build of the program. An entry is one file, written whole or not at all, that carries
 * its length and checksum; one that is truncated, altered or another key's counts as missing. Any
 * number of processes may use a folder at once. */
#ifndef SPHPROOF_CACHE_H
#define SPHPROOF_CACHE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum { CACHE_PATH_MAX = 4096, CACHE_BUILD_MAX = 17 };

struct cache {
    char folder[CACHE_PATH_MAX - 64];
    char build[CACHE_BUILD_MAX]; /* hash of the executable and the C library's version */
    bool force;                  /* entries are written, not read */
};

/* Makes the folder where needed and removes entries that nobody has used for a month. */
enum status cache_open(struct cache *cache, const char *folder, bool force, struct error *error);

/* The document kept under key, a new reference; NULL where there is none that is sound. */
json_t *cache_load(const struct cache *cache, const char *key);

/* Keeps document under key. */
enum status cache_store(const struct cache *cache, const char *key, const json_t *document,
                        struct error *error);

/* Where the entry of key is or would be. */
void cache_path(const struct cache *cache, const char *key, char path[CACHE_PATH_MAX]);

/* Fowler, Noll and Vo's hash 1a of n bytes; it begins with CACHE_HASH or goes on from another. */
#define CACHE_HASH UINT64_C(0xcbf29ce484222325)
uint64_t cache_hash(uint64_t hash, const void *bytes, size_t n);

#endif
