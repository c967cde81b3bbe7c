/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fuzzes entries of the cache: the bytes as they are, and as the body of an entry with a correct
 * checksum. Each must be read as a document or count as missing. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cache.h"
#include "fuzz.h"
#include "output.h"

static struct cache cache;
static char path[CACHE_PATH_MAX];

static void leave(void)
{
    unlink(path);
    *strrchr(path, '/') = '\0';
    rmdir(path);
    rmdir(cache.folder);
}

static void begin(void)
{
    static char folder[] = "sphproof-fuzz.XXXXXX";
    struct error error = {0};
    if (!mkdtemp(folder) || cache_open(&cache, folder, false, &error)) {
        fprintf(stderr, "fuzz: no folder: %s\n", error.message);
        exit(STATUS_ENVIRONMENT);
    }
    strcpy(cache.build, "0123456789abcdef"); /* the build of the corpus's entries */
    cache_path(&cache, "key", path);
    *strrchr(path, '/') = '\0';
    if (output_folder(path, &error)) exit(STATUS_ENVIRONMENT);
    path[strlen(path)] = '/';
    atexit(leave);
    /* a file in memory, because each input is another entry */
    if (symlink(fuzz_file(NULL, 0), path)) exit(STATUS_ENVIRONMENT);
}

/* With a header the entry is a document with a correct checksum. */
static void look(const uint8_t *bytes, size_t size, bool with_head)
{
    char head[64];
    const int length = with_head
                           ? snprintf(head, sizeof head, "sphproof-entry/1 %016" PRIx64 " %zu\n",
                                      cache_hash(CACHE_HASH, bytes, size), size)
                           : 0;
    uint8_t *entry = malloc((size_t)length + size + 1);
    if (!entry) exit(STATUS_ENVIRONMENT);
    memcpy(entry, head, (size_t)length);
    memcpy(entry + length, bytes, size);
    fuzz_file(entry, (size_t)length + size);
    free(entry);
    json_t *document = cache_load(&cache, "key", NULL);
    FUZZ_PROMISE(!document || document->refcount == 1);
    json_decref(document);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    if (!cache.folder[0]) begin();
    look(bytes, size, false);
    look(bytes, size, true);
}
