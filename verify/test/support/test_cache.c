/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the cache with kill -9, and with two processes at once. */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#include <sys/wait.h>

#include "sample_jobs.h"

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
