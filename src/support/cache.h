/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results kept by content: an entry belongs to a key (all that decides a result: case and settings)
 * and to this build of the program on a processor whose sin, exp and pow have these last bits. An
 * entry is one file, written whole or not at all, that carries its length and checksum; one that is
 * truncated, altered or another key's counts as missing. Any number of processes, on any number of
 * machines that share the folder, may use it at once; entries lie in 256 folders, by their name. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum { CACHE_PATH_MAX = 4096, CACHE_BUILD_MAX = 17 };

struct cache {
    char folder[CACHE_PATH_MAX - 64];
    char build[CACHE_BUILD_MAX]; /* hash of the executable, the C library and its mathematics */
    bool force;                  /* entries are written, not read */
};

/* Which build of the program this is, on this processor. */
void cache_build(char build[CACHE_BUILD_MAX]);

/* Makes the folder where needed. Looks at no entry. */
enum status cache_open(struct cache *cache, const char *folder, bool force, struct error *error);

/* The document kept under key, a new reference; NULL where there is none that is sound. damaged
 * (may be NULL) becomes true where there is one that is not, else it stays as it is. */
json_t *cache_load(const struct cache *cache, const char *key, bool *damaged);

/* Is there an entry for key? Its file is not read. */
bool cache_has(const struct cache *cache, const char *key);

/* Keeps document under key. */
enum status cache_store(const struct cache *cache, const char *key, const json_t *document,
                        struct error *error);

/* Where the entry of key is or would be. */
void cache_path(const struct cache *cache, const char *key, char path[CACHE_PATH_MAX]);

/* Entries of a folder, and temporaries that killed processes left. */
struct cache_census {
    size_t entries, removed;
    double bytes; /* of the entries that are left */
};

/* Removes entries that have not been used for so many seconds (HUGE_VAL: none). STATUS_BAD_INPUT:
 * there is no such folder. */
enum status cache_prune(const char *folder, double seconds, struct cache_census *census,
                        struct error *error);
#define CACHE_MONTH (30. * 24 * 3600) /* seconds */

/* Fowler, Noll and Vo's hash 1a of n bytes; it begins with CACHE_HASH or goes on from another. */
#define CACHE_HASH UINT64_C(0xcbf29ce484222325)
uint64_t cache_hash(uint64_t hash, const void *bytes, size_t n);

/* The same of a whole file; 0: it cannot be read. */
uint64_t cache_hash_file(const char *path);
