/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cache.h"

#include <dirent.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

#include "output.h"
#include "result.h"
#include "version.h"

enum { ENTRY_MAX = 1 << 28, HEAD_MAX = 64, FOLDERS = 256 };

uint64_t cache_hash(uint64_t hash, const void *bytes, size_t n)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < n; i++) hash = (hash ^ byte[i]) * UINT64_C(0x100000001b3);
    return hash;
}

uint64_t cache_hash_file(const char *path)
{
    char bytes[4096];
    uint64_t hash = CACHE_HASH;
    FILE *file = fopen(path, "rb");
    if (!file) return 0;
    for (size_t got; (got = fread(bytes, 1, sizeof bytes, file)) > 0;)
        hash = cache_hash(hash, bytes, got);
    fclose(file);
    return hash;
}

static FILE *open_program(void)
{
#ifdef __APPLE__
    char path[CACHE_PATH_MAX];
    uint32_t size = sizeof path;
    return _NSGetExecutablePath(path, &size) ? NULL : fopen(path, "rb");
#else
    return fopen("/proc/self/exe", "rb");
#endif
}

/* Hashes the last bits of mathematical functions, which the C library chooses for the processor. */
static uint64_t hash_mathematics(uint64_t hash)
{
    for (int k = 1; k <= 64; k++) {
        const volatile double x = 0.37 * k;
        const double values[] = {sin(x), cos(x), exp(-x), log(x), pow(x, 1 / 3.), pow(x, -0.4)};
        hash = cache_hash(hash, values, sizeof values);
    }
    return hash;
}

/* Any change of the program, or of the mathematical library, gives another build. The program is
 * hashed by words, because it has millions of bytes. */
void cache_build(char build[CACHE_BUILD_MAX])
{
    uint64_t words[1 << 13] = {0};
    char *bytes = (char *)words;
    size_t n;
    uint64_t hash =
        cache_hash(CACHE_HASH, VERSION_FLAGS VERSION_GIT, sizeof VERSION_FLAGS VERSION_GIT);
    FILE *program = open_program();
    while (program && (n = fread(bytes, 1, sizeof words, program)) > 0) {
        memset(bytes + n, 0, sizeof words - n);
        for (size_t i = 0; i < (n + 7) / 8; i++) {
            hash = (hash ^ words[i]) * UINT64_C(0x100000001b3);
            hash ^= hash >> 32;
        }
    }
    if (program) fclose(program);
#ifdef _CS_GNU_LIBC_VERSION
    n = confstr(_CS_GNU_LIBC_VERSION, bytes, sizeof words);
    hash = cache_hash(hash, bytes, n < sizeof words ? n : sizeof words);
#endif
    snprintf(build, CACHE_BUILD_MAX, "%016" PRIx64, hash_mathematics(hash));
}

/* Prunes one of the folders of entries; also removes old temporaries of killed processes. */
static void prune(const char *folder, double seconds, struct cache_census *census)
{
    DIR *opened = opendir(folder);
    const time_t now = time(NULL);
    for (struct dirent *entry; opened && (entry = readdir(opened));) {
        char path[CACHE_PATH_MAX];
        struct stat is;
        if (!strstr(entry->d_name, ".entry") ||
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) >= (int)sizeof path ||
            stat(path, &is))
            continue;
        if (difftime(now, is.st_mtime) >= seconds && unlink(path) == 0) {
            census->removed++;
        } else {
            census->entries++;
            census->bytes += (double)is.st_size;
        }
    }
    if (opened) closedir(opened);
}

enum status cache_prune(const char *folder, double seconds, struct cache_census *census,
                        struct error *error)
{
    struct stat is;
    *census = (struct cache_census){0};
    if (stat(folder, &is) || !S_ISDIR(is.st_mode))
        return error_set(error, STATUS_BAD_INPUT, "there is no folder %.400s", folder);
    for (unsigned k = 0; k < FOLDERS; k++) {
        char path[CACHE_PATH_MAX];
        if (snprintf(path, sizeof path, "%s/%02x", folder, k) >= (int)sizeof path)
            return error_set(error, STATUS_BAD_INPUT, "the path of the cache is too long");
        prune(path, seconds, census);
    }
    return STATUS_OK;
}

enum status cache_open(struct cache *cache, const char *folder, bool force, struct error *error)
{
    cache->force = force;
    if (snprintf(cache->folder, sizeof cache->folder, "%s", folder) >= (int)sizeof cache->folder)
        return error_set(error, STATUS_BAD_INPUT, "the path of the cache is too long");
    const enum status status = output_folder(cache->folder, error);
    if (status) return status;
    cache_build(cache->build);
    return STATUS_OK;
}

void cache_path(const struct cache *cache, const char *key, char path[CACHE_PATH_MAX])
{
    uint64_t hash = cache_hash(CACHE_HASH, cache->build, strlen(cache->build));
    hash = cache_hash(hash, key, strlen(key));
    snprintf(path, CACHE_PATH_MAX, "%s/%02x/%016" PRIx64 ".entry", cache->folder,
             (unsigned)(hash % FOLDERS), hash);
}

/* A file's bytes and a NUL; NULL if it cannot be read. */
static char *read_file(const char *path, size_t *length)
{
    struct stat is;
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    if (file && !fstat(fileno(file), &is) && S_ISREG(is.st_mode) && is.st_size < ENTRY_MAX)
        text = malloc((size_t)is.st_size + 1);
    if (text) {
        *length = fread(text, 1, (size_t)is.st_size, file);
        text[*length] = '\0';
    }
    if (file) fclose(file);
    return text;
}

/* Writes the first line of an entry: length and checksum of its body. */
static int head_of(const char *body, size_t length, char head[HEAD_MAX])
{
    return snprintf(head, HEAD_MAX, "sphproof-entry/1 %016" PRIx64 " %zu\n",
                    cache_hash(CACHE_HASH, body, length), length);
}

/* The body of an entry, or NULL if its length or checksum is wrong. */
static const char *body_of(const char *text, size_t length)
{
    char head[HEAD_MAX];
    const char *end = memchr(text, '\n', length);
    if (!end) return NULL;
    const char *body = end + 1;
    const int size = head_of(body, (size_t)(text + length - body), head);
    return size == body - text && memcmp(text, head, (size_t)size) == 0 ? body : NULL;
}

bool cache_has(const struct cache *cache, const char *key)
{
    char path[CACHE_PATH_MAX];
    cache_path(cache, key, path);
    return !cache->force && access(path, R_OK) == 0;
}

json_t *cache_load(const struct cache *cache, const char *key, bool *damaged)
{
    char path[CACHE_PATH_MAX];
    size_t length = 0;
    json_t *document = NULL;
    if (cache->force) return NULL;
    cache_path(cache, key, path);
    char *text = read_file(path, &length);
    const char *body = text ? body_of(text, length) : NULL;
    json_t *entry = body ? json_loads(body, 0, NULL) : NULL;
    const char *build = json_string_value(json_object_get(entry, "build"));
    const char *own = json_string_value(json_object_get(entry, "key"));
    if (build && own && strcmp(build, cache->build) == 0 && strcmp(own, key) == 0)
        document = json_incref(json_object_get(entry, "document"));
    if (document) utimensat(AT_FDCWD, path, NULL, 0); /* marks the entry as used today */
    if (damaged && text && !document) *damaged = true;
    json_decref(entry);
    free(text);
    return document;
}

enum status cache_store(const struct cache *cache, const char *key, const json_t *document,
                        struct error *error)
{
    char path[CACHE_PATH_MAX];
    struct output output;
    json_t *entry =
        json_pack("{s:s, s:s, s:O}", "build", cache->build, "key", key, "document", document);
    char *text = entry ? result_text(entry) : NULL;
    json_decref(entry);
    if (!text) return error_set(error, STATUS_ENVIRONMENT, "no memory to keep a result");
    cache_path(cache, key, path);
    *strrchr(path, '/') = '\0';
    enum status status = output_folder(path, error);
    path[strlen(path)] = '/';
    if (!status) status = output_open(&output, path, error);
    if (!status) {
        char head[HEAD_MAX];
        head_of(text, strlen(text), head);
        fputs(head, output.stream);
        fputs(text, output.stream);
        status = output_close(&output, error);
    }
    free(text);
    return status;
}
