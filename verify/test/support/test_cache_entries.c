/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the cache's entries: their names and folders, which files are valid entries, and which are
 * removed. */
#include "test.h"

#include <fcntl.h>
#include <inttypes.h>
#include <sys/stat.h>
#include <time.h>

#include "cache.h"
#include "own_folder.h"
#include "version.h"

/* Fowler, Noll and Vo's own test vectors. */
TEST(hashes)
{
    assert_true(cache_hash(CACHE_HASH, "", 0) == UINT64_C(0xcbf29ce484222325));
    assert_true(cache_hash(CACHE_HASH, "a", 1) == UINT64_C(0xaf63dc4c8601ec8c));
    assert_true(cache_hash(CACHE_HASH, "foobar", 6) == UINT64_C(0x85944171f73967e8));
    assert_true(cache_hash(cache_hash(CACHE_HASH, "foo", 3), "bar", 3) ==
                UINT64_C(0x85944171f73967e8));
}

static struct cache opened(bool force)
{
    struct cache cache;
    struct error error;
    assert_int_equal(cache_open(&cache, own_folder, force, &error), STATUS_OK);
    assert_string_equal(cache.folder, own_folder);
    return cache;
}

/* The build is a hash of the program's bytes and of the mathematical functions it uses. */
TEST(identity_of_a_build)
{
    uint64_t hash = CACHE_HASH;
    char text[] = VERSION_FLAGS VERSION_GIT, build[CACHE_BUILD_MAX], said[CACHE_BUILD_MAX];
    hash = cache_hash(hash, text, sizeof text);
    FILE *program = fopen("/proc/self/exe", "rb");
    if (!program) skip(); /* without /proc there is no path of this program */
    for (uint64_t word = 0; fread(&word, 1, sizeof word, program) > 0; word = 0) {
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
        hash ^= hash >> 32;
    }
    fclose(program);
#ifdef _CS_GNU_LIBC_VERSION
    char library[256];
    hash = cache_hash(hash, library, confstr(_CS_GNU_LIBC_VERSION, library, sizeof library));
#endif
    for (int k = 1; k <= 64; k++) {
        const volatile double x = 0.37 * k;
        const double values[] = {sin(x), cos(x), exp(-x), log(x), pow(x, 1 / 3.), pow(x, -0.4)};
        hash = cache_hash(hash, values, sizeof values);
    }
    snprintf(build, sizeof build, "%016" PRIx64, hash);
    cache_build(said);
    assert_string_equal(said, build);
    const struct cache cache = opened(false);
    assert_string_equal(cache.build, build);
}

/* FOLDER/xx/xxxxxxxxxxxxxxxx.entry: the hash of build and key, in the folder of its last two
 * digits. */
TEST(paths)
{
    struct cache cache = {.folder = "/a/b", .build = "0123456789abcdef"};
    static const char *const keys[] = {"", "a", "another key"};
    for (int k = 0; k < 3; k++) {
        char path[CACHE_PATH_MAX], want[CACHE_PATH_MAX], both[64];
        snprintf(both, sizeof both, "%s%s", cache.build, keys[k]);
        const uint64_t hash = cache_hash(CACHE_HASH, both, strlen(both));
        snprintf(want, sizeof want, "/a/b/%02x/%016" PRIx64 ".entry", (unsigned)(hash & 0xff),
                 hash);
        cache_path(&cache, keys[k], path);
        assert_string_equal(path, want);
    }
}

/* The longest allowed path of a folder leaves enough characters for the names in it. */
TEST(folders)
{
    struct cache cache;
    struct error error;
    static char folder[2 * CACHE_PATH_MAX];
    memset(folder, '/', sizeof folder - 1);
    memcpy(folder, own_folder, strlen(own_folder));
    for (size_t length = sizeof cache.folder - 1; length <= sizeof cache.folder; length++) {
        memset(folder + strlen(own_folder), '/', length - strlen(own_folder));
        folder[length] = '\0';
        assert_int_equal(cache_open(&cache, folder, false, &error),
                         length < sizeof cache.folder ? STATUS_OK : STATUS_BAD_INPUT);
    }
    assert_string_equal(error.message, "the path of the cache is too long");
    char file[64];
    snprintf(file, sizeof file, "%s/file", own_folder);
    fclose(fopen(file, "w"));
    assert_int_equal(cache_open(&cache, file, false, &error), STATUS_ENVIRONMENT);
    unlink(file);
    snprintf(file, sizeof file, "%s/a/b", own_folder);
    assert_int_equal(cache_open(&cache, file, true, &error), STATUS_OK);
    assert_true(cache.force && rmdir(file) == 0);
    snprintf(file, sizeof file, "%s/a", own_folder);
    rmdir(file);
}

/* ---- entries ---- */

static void write_file(const char *path, const void *bytes, size_t n)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    assert_int_equal(fclose(file), 0);
}

/* A valid entry, and invalid ones. */
TEST(entries)
{
    struct cache cache = opened(false), forced = cache;
    struct error error;
    char path[CACHE_PATH_MAX], body[256], text[512];
    json_t *document = json_pack("{s:i}", "n", 7);
    forced.force = true;
    assert_false(cache_has(&cache, "key"));
    bool damaged = false;
    assert_null(cache_load(&cache, "key", &damaged));
    assert_false(damaged); /* it does not exist */
    assert_int_equal(cache_store(&cache, "key", document, &error), STATUS_OK);
    assert_true(cache_has(&cache, "key") && !cache_has(&forced, "key") &&
                !cache_has(&cache, "other"));
    assert_null(cache_load(&forced, "key", NULL));
    cache_path(&cache, "key", path);
    snprintf(body, sizeof body, "{\"build\":\"%s\",\"key\":\"key\",\"document\":{\"n\":7}}",
             cache.build);
    const int length = snprintf(text, sizeof text, "sphproof-entry/1 %016" PRIx64 " %zu\n%s",
                                cache_hash(CACHE_HASH, body, strlen(body)), strlen(body), body);
    FILE *file = fopen(path, "rb");
    char found[600];
    assert_non_null(file);
    assert_int_equal(fread(found, 1, sizeof found, file), length);
    fclose(file);
    assert_memory_equal(found, text, (size_t)length);
    /* one byte less, one more, a changed one, no line, an empty file; then valid entries of another
     * build or key, or without a document */
    static const char *const others[] = {
        "{\"build\":\"%.0s0\",\"key\":\"key\",\"document\":{\"n\":7}}",
        "{\"build\":\"%s\",\"key\":\"kex\",\"document\":{\"n\":7}}",
        "{\"key\":\"key\",\"document\":{\"n\":7}}",
        "{\"build\":\"%s\",\"document\":{\"n\":7}}",
        "{\"build\":\"%s\",\"key\":\"key\"}",
        "[1]",
        "no JSON",
        "",
    };
    for (int k = -1; k < 5 + (int)(sizeof others / sizeof *others); k++) {
        size_t n = (size_t)length;
        memcpy(found, text, n);
        if (k == 0) n--;
        if (k == 1) found[n++] = '\n';
        if (k == 2) found[n - 4] = '8';
        if (k == 3) n = strcspn(text, "\n");
        if (k == 4) n = 0;
        if (k > 4) {
            snprintf(body, sizeof body, others[k - 5], cache.build);
            n = (size_t)snprintf(found, sizeof found, "sphproof-entry/1 %016" PRIx64 " %zu\n%s",
                                 cache_hash(CACHE_HASH, body, strlen(body)), strlen(body), body);
        }
        write_file(path, found, n);
        damaged = false;
        json_t *loaded = cache_load(&cache, "key", &damaged);
        if (!loaded != (k >= 0) || damaged != (k >= 0)) fail_msg("entry %d", k);
        if (loaded) assert_true(json_equal(loaded, document));
        json_decref(loaded);
        assert_null(k < 0 ? NULL : cache_load(&cache, "key", NULL));
    }
    /* if a member is repeated, the last one counts */
    snprintf(body, sizeof body,
             "{\"build\":\"%s\",\"key\":\"kex\",\"key\":\"key\",\"document\":{\"n\":7}}",
             cache.build);
    snprintf(found, sizeof found, "sphproof-entry/1 %016" PRIx64 " %zu\n%s",
             cache_hash(CACHE_HASH, body, strlen(body)), strlen(body), body);
    write_file(path, found, strlen(found));
    json_t *loaded = cache_load(&cache, "key", NULL);
    assert_true(json_equal(loaded, document));
    json_decref(loaded);
    /* reading an entry resets its age */
    const struct timespec old[2] = {{.tv_sec = 1000}, {.tv_sec = 1000}};
    struct stat is;
    write_file(path, text, (size_t)length);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(utimensat(AT_FDCWD, path, old, 0), 0);
        json_decref(cache_load(&cache, k ? "key" : "other", NULL));
        assert_int_equal(stat(path, &is), 0);
        assert_true(k ? difftime(time(NULL), is.st_mtime) < 1000 : is.st_mtime == 1000);
    }
    /* a correct header that does not begin the file */
    snprintf(found, sizeof found, "\n%s", text);
    write_file(path, found, (size_t)length + 1);
    assert_null(cache_load(&cache, "key", NULL));
    /* too large to be read: missing, not damaged */
    const int large = open(path, O_WRONLY | O_TRUNC);
    assert_true(large >= 0 && ftruncate(large, 1 << 28) == 0 && close(large) == 0);
    damaged = false;
    assert_null(cache_load(&cache, "key", &damaged));
    assert_false(damaged);
    unlink(path);
    assert_int_equal(mkdir(path, 0777), 0); /* nor is a folder an entry */
    assert_null(cache_load(&cache, "key", &damaged));
    assert_false(damaged);
    rmdir(path);
    assert_int_equal(cache_store(&cache, "key", NULL, &error), STATUS_ENVIRONMENT);
    assert_string_equal(error.message, "no memory to keep a result");
    *strrchr(path, '/') = '\0';
    rmdir(path);
    write_file(path, "", 0); /* a file in place of the entry's folder */
    assert_int_equal(cache_store(&cache, "key", document, &error), STATUS_ENVIRONMENT);
    unlink(path);
    json_decref(document);
}

/* ---- removal ---- */

static void make_entry(const char *name, size_t bytes, double age)
{
    char path[256];
    struct timespec times[2] = {0};
    snprintf(path, sizeof path, "%s/%s", own_folder, name);
    char *slash = strrchr(path, '/');
    *slash = '\0';
    mkdir(path, 0777);
    *slash = '/';
    write_file(path, "12345678", bytes);
    times[0].tv_sec = times[1].tv_sec = time(NULL) - (time_t)age;
    assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static bool is_there(const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", own_folder, name);
    return access(path, F_OK) == 0;
}

TEST(pruning_by_age)
{
    struct cache_census census;
    struct error error;
    make_entry("00/0.entry", 1, 1000);
    make_entry("00/1.entry", 2, 3000);
    make_entry("7f/.2.entry.123.0.part", 4, 3000); /* of a process that was killed */
    make_entry("ff/3.entry", 8, 1000);
    make_entry("ff/README", 5, 9000); /* not an entry */
    make_entry("fg/4.entry", 5, 9000);
    assert_int_equal(cache_prune(own_folder, HUGE_VAL, &census, &error), STATUS_OK);
    assert_true(census.entries == 4 && census.removed == 0 && census.bytes == 15);
    assert_int_equal(cache_prune(own_folder, 2000, &census, &error), STATUS_OK);
    assert_true(census.entries == 2 && census.removed == 2 && census.bytes == 9);
    assert_true(is_there("00/0.entry") && is_there("ff/3.entry") && is_there("ff/README") &&
                is_there("fg/4.entry") && !is_there("00/1.entry") &&
                !is_there("7f/.2.entry.123.0.part"));
    assert_int_equal(cache_prune(own_folder, 1000, &census, &error),
                     STATUS_OK); /* entries of exactly that age */
    assert_int_equal(census.removed, 2);
    make_entry("00/0.entry", 1, 0);
    make_entry("ff/3.entry", 8, 0);
    assert_int_equal(cache_prune(own_folder, 0, &census, &error), STATUS_OK);
    assert_true(census.entries == 0 && census.removed == 2 && census.bytes == 0);
    assert_true(is_there("ff/README") && is_there("fg/4.entry"));
    /* folders that cannot be read */
    char path[256], said[300];
    snprintf(path, sizeof path, "%s/ff/README", own_folder);
    snprintf(said, sizeof said, "there is no folder %s", path);
    assert_int_equal(cache_prune(path, 1, &census, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, said);
    assert_int_equal(cache_prune("/no/such", 1, &census, &error), STATUS_BAD_INPUT);
    assert_string_equal(error.message, "there is no folder /no/such");
    static char folder[CACHE_PATH_MAX];
    memset(folder, '/', sizeof folder);
    memcpy(folder, own_folder, strlen(own_folder));
    /* names too long for the path are left alone, whatever file has the truncated name */
    make_entry("00/3.entry", 1, 0);
    make_entry("00/3.entryx", 1, 0);
    for (size_t spare = 11; spare <= 12; spare++) { /* for "/00/3.entry" and a NUL */
        folder[CACHE_PATH_MAX - spare - 1] = '\0';
        assert_int_equal(cache_prune(folder, 1000, &census, &error), STATUS_OK);
        assert_int_equal(census.entries, spare - 10);
        folder[CACHE_PATH_MAX - spare - 1] = '/';
    }
    for (size_t spare = 3; spare <= 4; spare++) { /* for "/xx" and a NUL */
        folder[CACHE_PATH_MAX - spare] = '\0';
        assert_int_equal(cache_prune(folder, 1, &census, &error),
                         spare == 4 ? STATUS_OK : STATUS_BAD_INPUT);
        if (spare == 3) assert_string_equal(error.message, "the path of the cache is too long");
        folder[CACHE_PATH_MAX - spare] = '/';
    }
}
