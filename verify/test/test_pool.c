/* SPDX-License-Identifier: GPL-3.0-or-later
 * Computations side by side and the cache: the same results with any number of processes and from
 * the cache; damaged entries, crashes, kill -9 and two at once. */
#define _GNU_SOURCE /* nftw */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <math.h>

#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pool.h"
#include "result.h"

enum { JOBS = 7 };

/* One test's folder: the cache, and a file that grows by a byte with each computation. */
struct place {
    char folder[64], count[80], cache_folder[80];
    struct cache cache;
};

struct task {
    const struct place *place;
    int number;
    enum { SOUND, BROKEN, CRASHES, FAILS, SLOW } kind;
};

static enum status compute(const void *context, json_t **document, struct error *error)
{
    const struct task *task = context;
    FILE *count = fopen(task->place->count, "a");
    fputc('.', count);
    fclose(count);
    if (task->kind == CRASHES) raise(SIGKILL);
    if (task->kind == SLOW) sleep(60);
    if (task->kind == FAILS) return error_set(error, STATUS_ENVIRONMENT, "no luck");
    *document = json_pack("{s:i, s:o, s:o}", "number", task->number, "third",
                          result_number(task->number / 3.), "nan", result_number(0 / 0.));
    /* larger than any pipe's buffer */
    char *long_text = malloc(300001);
    memset(long_text, 'a' + task->number, 300000);
    long_text[300000] = '\0';
    json_object_set_new(*document, "long", json_string(long_text));
    free(long_text);
    return task->kind == BROKEN ? error_set(error, STATUS_BROKE_DOWN, "particle 3") : STATUS_OK;
}

static void place_make(struct place *place)
{
    struct error error = {0};
    strcpy(place->folder, "pool.XXXXXX");
    assert_non_null(mkdtemp(place->folder));
    snprintf(place->count, sizeof place->count, "%s/count", place->folder);
    snprintf(place->cache_folder, sizeof place->cache_folder, "%s/cache", place->folder);
    assert_int_equal(cache_open(&place->cache, place->cache_folder, false, &error), STATUS_OK);
}

static int remove_one(const char *path, const struct stat *is, int type, struct FTW *depth)
{
    (void)is, (void)type, (void)depth;
    return remove(path);
}

static void place_clear(const struct place *place)
{
    nftw(place->cache_folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
    unlink(place->count);
    rmdir(place->folder);
}

static long computed(const struct place *place)
{
    struct stat is;
    return stat(place->count, &is) ? 0 : (long)is.st_size;
}

static void fill(struct pool *pool, struct task *tasks, const struct place *place, size_t n)
{
    *pool = (struct pool){0};
    for (size_t i = 0; i < n; i++) {
        char name[32];
        tasks[i].place = place;
        tasks[i].number = (int)i;
        snprintf(name, sizeof name, "task %zu", i);
        assert_int_equal(pool_add(pool, name, name, (double)(i % 3), compute, &tasks[i]), i);
    }
}

static enum status run(struct pool *pool, const struct cache *cache, int jobs)
{
    struct error error = {0};
    const struct pool_settings settings = {.jobs = jobs, .cache = cache};
    return pool_run(pool, &settings, &error);
}

static void same_results(const struct pool *a, const struct pool *b)
{
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        assert_true(a->jobs[i].done && b->jobs[i].done);
        assert_true(json_equal(a->jobs[i].document, b->jobs[i].document));
        assert_int_equal(a->jobs[i].error.status, b->jobs[i].error.status);
        assert_string_equal(a->jobs[i].error.message, b->jobs[i].error.message);
    }
}

static void any_number_of_processes(void **state)
{
    (void)state;
    struct place place;
    struct pool one, two, kept;
    struct task tasks[3][JOBS] = {0};
    place_make(&place);
    tasks[0][2].kind = tasks[1][2].kind = tasks[2][2].kind = BROKEN;
    fill(&one, tasks[0], &place, JOBS);
    fill(&two, tasks[1], &place, JOBS);
    fill(&kept, tasks[2], &place, JOBS);
    assert_int_equal(run(&one, NULL, 1), STATUS_OK);
    assert_int_equal(run(&two, &place.cache, 3), STATUS_OK);
    assert_int_equal(computed(&place), 2 * JOBS);
    assert_int_equal(run(&kept, &place.cache, 2), STATUS_OK);
    assert_int_equal(computed(&place), 2 * JOBS);
    assert_int_equal(kept.found, JOBS);
    assert_int_equal(two.found, 0);
    same_results(&one, &two);
    same_results(&one, &kept);
    assert_int_equal(one.jobs[2].error.status, STATUS_BROKE_DOWN);
    assert_int_equal(json_integer_value(json_object_get(one.jobs[5].document, "number")), 5);
    struct cache force = place.cache;
    force.force = true;
    pool_free(&kept);
    fill(&kept, tasks[2], &place, JOBS);
    assert_int_equal(run(&kept, &force, 2), STATUS_OK);
    assert_int_equal(computed(&place), 3 * JOBS);
    same_results(&one, &kept);
    pool_free(&one);
    pool_free(&two);
    pool_free(&kept);
    place_clear(&place);
}

/* A crash or a failure is one job's own and is not kept. */
static void crashes(void **state)
{
    (void)state;
    struct place place;
    struct pool pool;
    struct task tasks[4] = {[1] = {.kind = CRASHES}, [2] = {.kind = FAILS}};
    place_make(&place);
    for (int round = 1; round <= 2; round++) {
        fill(&pool, tasks, &place, 4);
        assert_int_equal(run(&pool, &place.cache, 2), STATUS_OK);
        assert_int_equal(pool.found, round == 1 ? 0 : 2);
        assert_int_equal(pool.jobs[1].error.status, STATUS_BROKE_DOWN);
        assert_non_null(strstr(pool.jobs[1].error.message, "signal 9"));
        assert_int_equal(pool.jobs[2].error.status, STATUS_ENVIRONMENT);
        assert_string_equal(pool.jobs[2].error.message, "no luck");
        assert_null(pool.jobs[1].document);
        assert_non_null(pool.jobs[3].document);
        pool_free(&pool);
    }
    place_clear(&place);
}

/* Every job in one share, the same whatever their order; even by weight. Equal keys are one job. */
static void shares(void **state)
{
    enum { MANY = 200 };
    static int divided[MANY], again[MANY];
    struct pool pool = {0}, turned = {0};
    struct error error = {0};
    double load[6] = {0}, least = 1e9, most = 0;
    (void)state;
    for (size_t i = 0; i < MANY; i++) {
        char key[2][32];
        const size_t numbers[2] = {i, MANY - 1 - i};
        for (int k = 0; k < 2; k++) {
            struct pool *of = k ? &turned : &pool;
            const char *name = numbers[k] == 7 ? NULL : key[k];
            snprintf(key[k], sizeof key[k], "key %zu", numbers[k]);
            for (int times = 0; times < 2; times++) {
                if (times && !name) continue;
                assert_int_equal(
                    pool_add(of, "job", name, 1 + (double)(numbers[k] * 37 % 100), compute, NULL),
                    i);
            }
        }
    }
    assert_int_equal(pool_divide(&pool, 5, divided, &error), STATUS_OK);
    assert_int_equal(pool_divide(&turned, 5, again, &error), STATUS_OK);
    for (size_t i = 0; i < MANY; i++) {
        assert_int_equal(divided[i], again[MANY - 1 - i]);
        assert_true(i == 7 ? divided[i] == 0 : divided[i] >= 1 && divided[i] <= 5);
        load[divided[i]] += pool.jobs[i].weight;
    }
    for (int s = 1; s <= 5; s++) {
        least = load[s] < least ? load[s] : least;
        most = load[s] > most ? load[s] : most;
    }
    assert_true(most - least <= 100); /* the heaviest job */
    pool_free(&pool);
    pool_free(&turned);
}

/* Three processes with a share each, one after the other: then all is there, computed once. */
static void shares_meet(void **state)
{
    struct place place;
    struct pool pool, alone;
    struct task tasks[JOBS] = {0}, others[JOBS] = {0};
    struct error error = {0};
    (void)state;
    place_make(&place);
    for (int s = 1; s <= 3; s++) {
        size_t mine = 0;
        fill(&pool, tasks, &place, JOBS);
        const struct pool_settings settings = {
            .jobs = 2, .cache = &place.cache, .share = {.number = s, .of = 3}};
        assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
        for (size_t i = 0; i < JOBS; i++) {
            assert_true(pool.jobs[i].done != pool.jobs[i].elsewhere);
            mine += pool.jobs[i].done;
        }
        assert_true(mine >= 1 && mine <= JOBS - 2);
        pool_free(&pool);
    }
    assert_int_equal(computed(&place), JOBS);
    fill(&pool, tasks, &place, JOBS);
    fill(&alone, others, &place, JOBS);
    assert_int_equal(run(&pool, &place.cache, 2), STATUS_OK);
    assert_int_equal(pool.found, JOBS);
    assert_int_equal(run(&alone, NULL, 2), STATUS_OK);
    same_results(&pool, &alone);
    pool_free(&pool);
    pool_free(&alone);
    place_clear(&place);
}

/* Old entries go when they are asked to, not when somebody else opens the folder. */
static void pruned(void **state)
{
    struct place place;
    struct cache_census census;
    struct error error = {0};
    char path[CACHE_PATH_MAX];
    (void)state;
    place_make(&place);
    json_t *document = json_pack("{s:i}", "value", 1);
    const struct timespec month[2] = {{.tv_sec = time(NULL) - (time_t)CACHE_MONTH - 60},
                                      {.tv_sec = time(NULL) - (time_t)CACHE_MONTH - 60}};
    for (int k = 0; k < 3; k++) {
        char key[8];
        snprintf(key, sizeof key, "%d", k);
        assert_int_equal(cache_store(&place.cache, key, document, &error), STATUS_OK);
        assert_true(cache_has(&place.cache, key));
        cache_path(&place.cache, key, path);
        if (k) assert_int_equal(utimensat(AT_FDCWD, path, month, 0), 0);
    }
    json_decref(document);
    json_decref(cache_load(&place.cache, "2", NULL)); /* used: young again */
    assert_int_equal(cache_open(&place.cache, place.cache_folder, false, &error), STATUS_OK);
    assert_int_equal(cache_prune(place.cache_folder, HUGE_VAL, &census, &error), STATUS_OK);
    assert_true(census.entries == 3 && census.removed == 0 && census.bytes > 0);
    assert_int_equal(cache_prune(place.cache_folder, CACHE_MONTH, &census, &error), STATUS_OK);
    assert_true(census.entries == 2 && census.removed == 1);
    assert_true(cache_has(&place.cache, "0") && !cache_has(&place.cache, "1") &&
                cache_has(&place.cache, "2"));
    assert_int_equal(cache_prune("no/such", 1, &census, &error), STATUS_BAD_INPUT);
    place_clear(&place);
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

/* Every truncation and every altered byte counts as missing; so does another key's entry. */
static void damaged_entries(void **state)
{
    (void)state;
    struct place place;
    struct error error = {0};
    char path[CACHE_PATH_MAX], other[CACHE_PATH_MAX], bytes[4096], damaged[4096];
    place_make(&place);
    json_t *document = json_pack("{s:f, s:[i, i]}", "value", 0.1, "list", 1, 2);
    assert_int_equal(cache_store(&place.cache, "key", document, &error), STATUS_OK);
    json_t *back = cache_load(&place.cache, "key", NULL);
    assert_true(json_equal(back, document));
    json_decref(back);
    cache_path(&place.cache, "key", path);
    const size_t n = read_all(path, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++) {
        bool seen = false;
        write_all(path, bytes, i);
        assert_null(cache_load(&place.cache, "key", &seen));
        assert_true(seen);
        memcpy(damaged, bytes, n);
        damaged[i] = (char)(damaged[i] ^ (1 << (i % 7)));
        write_all(path, damaged, n);
        assert_null(cache_load(&place.cache, "key", NULL));
    }
    write_all(path, bytes, n);
    back = cache_load(&place.cache, "key", NULL);
    assert_non_null(back);
    json_decref(back);
    cache_path(&place.cache, "other key", other);
    *strrchr(other, '/') = '\0';
    mkdir(other, 0777);
    other[strlen(other)] = '/';
    write_all(other, bytes, n);
    assert_null(cache_load(&place.cache, "other key", NULL));
    /* another build has entries of its own */
    struct cache rebuilt = place.cache;
    rebuilt.build[0] = rebuilt.build[0] == '0' ? '1' : '0';
    assert_null(cache_load(&rebuilt, "key", NULL));
    json_decref(document);
    place_clear(&place);
}

/* The process is killed in the midst of its third job: the first two are there, whole. */
static void killed(void **state)
{
    (void)state;
    struct place place;
    struct pool pool;
    struct task tasks[JOBS] = {0};
    place_make(&place);
    const pid_t child = fork();
    if (child == 0) {
        setpgid(0, 0);
        struct task slow[JOBS] = {[2] = {.kind = SLOW}};
        pool = (struct pool){0};
        for (int i = 0; i < JOBS; i++) {
            char name[32];
            slow[i].place = &place;
            slow[i].number = i;
            snprintf(name, sizeof name, "task %d", i);
            pool_add(&pool, name, name, JOBS - i, compute, &slow[i]);
        }
        run(&pool, &place.cache, 1);
        _exit(0);
    }
    for (int i = 0; i < 1000 && computed(&place) < 3; i++) usleep(10000);
    assert_int_equal(computed(&place), 3);
    kill(-child, SIGKILL);
    waitpid(child, NULL, 0);
    fill(&pool, tasks, &place, JOBS);
    assert_int_equal(run(&pool, &place.cache, 2), STATUS_OK);
    assert_int_equal(pool.found, 2);
    assert_int_equal(computed(&place), 3 + JOBS - 2);
    pool_free(&pool);
    place_clear(&place);
}

/* Two processes with the same jobs and the same cache: both get all results, the entries are sound.
 */
static void two_at_once(void **state)
{
    (void)state;
    struct place place;
    struct pool pool, alone;
    struct task tasks[JOBS] = {0}, again[JOBS] = {0};
    pid_t children[2];
    place_make(&place);
    for (int c = 0; c < 2; c++)
        if ((children[c] = fork()) == 0) {
            bool well = true;
            for (int round = 0; round < 5; round++) {
                struct cache cache = place.cache;
                cache.force = round % 2;
                pool = (struct pool){0};
                for (size_t i = 0; i < JOBS; i++) {
                    char name[32];
                    tasks[i] = (struct task){.place = &place, .number = (int)i};
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
    fill(&pool, tasks, &place, JOBS);
    fill(&alone, again, &place, JOBS);
    assert_int_equal(run(&pool, &place.cache, 1), STATUS_OK);
    assert_int_equal(pool.found, JOBS);
    assert_int_equal(run(&alone, NULL, 1), STATUS_OK);
    same_results(&pool, &alone);
    pool_free(&pool);
    pool_free(&alone);
    place_clear(&place);
}

/* Where nothing can be kept, results are still there, and the pool says why. */
static void full_disk(void **state)
{
    (void)state;
    struct place place;
    struct pool pool;
    struct task tasks[2] = {0};
    place_make(&place);
    struct cache gone = place.cache;
    snprintf(gone.folder, sizeof gone.folder, "/dev/null/missing");
    fill(&pool, tasks, &place, 2);
    assert_int_equal(run(&pool, &gone, 2), STATUS_OK);
    assert_non_null(pool.jobs[0].document);
    assert_non_null(strstr(pool.note, "/dev/null"));
    pool_free(&pool);
    place_clear(&place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_number_of_processes),
        cmocka_unit_test(shares),
        cmocka_unit_test(shares_meet),
        cmocka_unit_test(pruned),
        cmocka_unit_test(crashes),
        cmocka_unit_test(damaged_entries),
        cmocka_unit_test(killed),
        cmocka_unit_test(two_at_once),
        cmocka_unit_test(full_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
