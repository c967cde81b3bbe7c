/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the cache with damaged and old entries, kill -9, and two processes at once. */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#include <fcntl.h>
#include <time.h>
#include <sys/wait.h>

#include "sample_jobs.h"

/* Old entries are removed on request, and not when another process opens the folder. */
TEST(old_entries_are_pruned)
{
    struct job_folder folder;
    struct cache_census census;
    struct error error = {0};
    char path[CACHE_PATH_MAX];
    job_folder_make(&folder);
    json_t *document = json_pack("{s:i}", "value", 1);
    const struct timespec month[2] = {{.tv_sec = time(NULL) - (time_t)CACHE_MONTH - 60},
                                      {.tv_sec = time(NULL) - (time_t)CACHE_MONTH - 60}};
    for (int k = 0; k < 3; k++) {
        char key[8];
        snprintf(key, sizeof key, "%d", k);
        assert_int_equal(cache_store(&folder.cache, key, document, &error), STATUS_OK);
        assert_true(cache_has(&folder.cache, key));
        cache_path(&folder.cache, key, path);
        if (k) assert_int_equal(utimensat(AT_FDCWD, path, month, 0), 0);
    }
    json_decref(document);
    json_decref(cache_load(&folder.cache, "2", NULL)); /* reading it resets its age */
    assert_int_equal(cache_open(&folder.cache, folder.cache_folder, false, &error), STATUS_OK);
    assert_int_equal(cache_prune(folder.cache_folder, HUGE_VAL, &census, &error), STATUS_OK);
    assert_true(census.entries == 3 && census.removed == 0 && census.bytes > 0);
    assert_int_equal(cache_prune(folder.cache_folder, CACHE_MONTH, &census, &error), STATUS_OK);
    assert_true(census.entries == 2 && census.removed == 1);
    assert_true(cache_has(&folder.cache, "0") && !cache_has(&folder.cache, "1") &&
                cache_has(&folder.cache, "2"));
    assert_int_equal(cache_prune("no/such", 1, &census, &error), STATUS_BAD_INPUT);
    job_folder_clear(&folder);
}

static size_t read_all(const char *path, char *bytes, size_t size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t n = fread(bytes, 1, size, file);
    fclose(file);
    return n;
}

static void write_all(const char *path, const char *bytes, size_t n)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, n, file), n);
    fclose(file);
}

/* A truncated entry, one with any changed byte and that of another key count as missing. */
TEST(damaged_entries)
{
    struct job_folder folder;
    struct error error = {0};
    char path[CACHE_PATH_MAX], other[CACHE_PATH_MAX], bytes[4096], damaged[4096];
    job_folder_make(&folder);
    json_t *document = json_pack("{s:f, s:[i, i]}", "value", 0.1, "list", 1, 2);
    assert_int_equal(cache_store(&folder.cache, "key", document, &error), STATUS_OK);
    json_t *back = cache_load(&folder.cache, "key", NULL);
    assert_true(json_equal(back, document));
    json_decref(back);
    cache_path(&folder.cache, "key", path);
    const size_t n = read_all(path, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++) {
        bool seen = false;
        write_all(path, bytes, i);
        assert_null(cache_load(&folder.cache, "key", &seen));
        assert_true(seen);
        memcpy(damaged, bytes, n);
        damaged[i] = (char)(damaged[i] ^ (1 << (i % 7)));
        write_all(path, damaged, n);
        assert_null(cache_load(&folder.cache, "key", NULL));
    }
    write_all(path, bytes, n);
    back = cache_load(&folder.cache, "key", NULL);
    assert_non_null(back);
    json_decref(back);
    cache_path(&folder.cache, "other key", other);
    *strrchr(other, '/') = '\0';
    mkdir(other, 0777);
    other[strlen(other)] = '/';
    write_all(other, bytes, n);
    assert_null(cache_load(&folder.cache, "other key", NULL));
    /* another build has entries of its own */
    struct cache rebuilt = folder.cache;
    rebuilt.build[0] = rebuilt.build[0] == '0' ? '1' : '0';
    assert_null(cache_load(&rebuilt, "key", NULL));
    json_decref(document);
    job_folder_clear(&folder);
}

/* If the process is killed during its third job, the first two entries are complete. */
TEST(killed_process_leaves_whole_entries)
{
    struct job_folder folder;
    struct pool pool;
    struct task tasks[JOBS] = {0};
    job_folder_make(&folder);
    const pid_t child = fork();
    if (child == 0) {
        setpgid(0, 0);
        struct task slow[JOBS] = {[2] = {.kind = SLOW}};
        pool = (struct pool){0};
        for (int i = 0; i < JOBS; i++) {
            char name[32];
            slow[i].folder = &folder;
            slow[i].number = i;
            snprintf(name, sizeof name, "task %d", i);
            pool_add(&pool, name, name, JOBS - i, compute, &slow[i]);
        }
        run(&pool, &folder.cache, 1);
        _exit(0);
    }
    for (int i = 0; i < 1000 && computed(&folder) < 3; i++) usleep(10000);
    assert_int_equal(computed(&folder), 3);
    kill(-child, SIGKILL);
    waitpid(child, NULL, 0);
    fill(&pool, tasks, &folder, JOBS);
    assert_int_equal(run(&pool, &folder.cache, 2), STATUS_OK);
    assert_int_equal(pool.found, 2);
    assert_int_equal(computed(&folder), 3 + JOBS - 2);
    pool_free(&pool);
    job_folder_clear(&folder);
}

/* Two processes with the same jobs and cache: both get all results, and the entries are valid. */
TEST(two_processes_share_a_cache)
{
    struct job_folder folder;
    struct pool pool, alone;
    struct task tasks[JOBS] = {0}, again[JOBS] = {0};
    pid_t children[2];
    job_folder_make(&folder);
    for (int c = 0; c < 2; c++)
        if ((children[c] = fork()) == 0) {
            bool well = true;
            for (int round = 0; round < 5; round++) {
                struct cache cache = folder.cache;
                cache.force = round % 2;
                pool = (struct pool){0};
                for (size_t i = 0; i < JOBS; i++) {
                    char name[32];
                    tasks[i] = (struct task){.folder = &folder, .number = (int)i};
                    snprintf(name, sizeof name, "task %zu", i);
                    pool_add(&pool, name, name, 1, compute, &tasks[i]);
                }
                well = well && run(&pool, &cache, 2) == STATUS_OK && !pool.note[0];
                for (size_t i = 0; i < JOBS; i++)
                    well = well && pool.jobs[i].document && !pool.jobs[i].error.status;
                pool_free(&pool);
            }
            _exit(well ? 0 : 1);
        }
    for (int c = 0; c < 2; c++) {
        int status;
        waitpid(children[c], &status, 0);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    fill(&pool, tasks, &folder, JOBS);
    fill(&alone, again, &folder, JOBS);
    assert_int_equal(run(&pool, &folder.cache, 1), STATUS_OK);
    assert_int_equal(pool.found, JOBS);
    assert_int_equal(run(&alone, NULL, 1), STATUS_OK);
    same_results(&pool, &alone);
    pool_free(&pool);
    pool_free(&alone);
    job_folder_clear(&folder);
}
