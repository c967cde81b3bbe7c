/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results cached by content: an entry belongs to a key (everything that determines a result: case
 * and settings) and to this build of the program on a processor with these last bits of sin, exp
 * and pow. An entry is one file, written whole or not at all, with its length and checksum; an
 * entry that is truncated, altered or of another key counts as missing. Any number of processes, on
 * any number of machines that share the folder, may use it at once; entries are distributed over
 * 256 folders by name. */
#pragma once

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "status.h"

enum { CACHE_PATH_MAX = 4096, CACHE_BUILD_MAX = 17 };

struct cache {
    char folder[CACHE_PATH_MAX - 64];
    char build[CACHE_BUILD_MAX]; /* hash of executable, C library and its mathematics */
    bool force;                  /* writes entries without reading any */
};

/* Identifies this build of the program on this processor. */
void cache_build(char build[CACHE_BUILD_MAX]);

/* Creates the folder if needed. Reads no entry. */
enum status cache_open(struct cache *cache, const char *folder, bool force, struct error *error);

/* The document stored under key, a new reference; NULL if there is no valid one. damaged (may be
 * NULL): set to true if there is an invalid one, otherwise unchanged. */
json_t *cache_load(const struct cache *cache, const char *key, bool *damaged);

/* True if there is an entry for key; does not read its file. */
bool cache_has(const struct cache *cache, const char *key);

/* Stores document under key. */
enum status cache_store(const struct cache *cache, const char *key, const json_t *document,
                        struct error *error);

/* Path of the entry of key, whether it exists or not. */
void cache_path(const struct cache *cache, const char *key, char path[CACHE_PATH_MAX]);

/* Counts of the entries of a folder, including temporaries of killed processes. */
struct cache_census {
    size_t entries, removed;
    double bytes; /* of the remaining entries */
};

/* Removes entries unused for this time (HUGE_VAL: none). STATUS_BAD_INPUT: no such folder. */
enum status cache_prune(const char *folder, double seconds, struct cache_census *census,
                        struct error *error);
#define CACHE_MONTH (30. * 24 * 3600) /* seconds */

/* Fowler, Noll and Vo's hash 1a of n bytes; starts with CACHE_HASH or continues another hash. */
#define CACHE_HASH UINT64_C(0xcbf29ce484222325)
uint64_t cache_hash(uint64_t hash, const void *bytes, size_t n);

/* The hash of a whole file; 0: it cannot be read. */
uint64_t cache_hash_file(const char *path);
