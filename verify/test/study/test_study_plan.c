/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the planned runs of a study: numbers of particles and seeds, the keys of results in the
 * cache, estimated times, and what is refused. */
#include "test.h"

#include <unistd.h>

#include "keyed.h"
#include "run_job.h"
#include "run_output.h"
#include "study.h"
#include "value.h"

enum { LEVELS = 4 };
static const size_t ladder[LEVELS] = {40, 60, 80, 400};

static enum status plan(struct study *study, struct pool *pool, const char *name, const char *keys,
                        const char *vary, size_t replicates, struct error *error)
{
    *error = (struct error){0};
    *pool = (struct pool){0};
    *study = (struct study){.level_count = LEVELS, .replicates = replicates};
    memcpy(study->ladder, ladder, sizeof ladder);
    study->settings = keyed_case(name, keys);
    if (sweep_parse(&study->sweep, vary, error)) fail_msg("%s", error->message);
    return study_plan(study, pool, error);
}

static double real_of(const struct run *run, enum setting key)
{
    return settings_real(&run->settings, key);
}

/* Combination, level, replicate: each run has its own number, and a job of that name and key. */
TEST(every_run)
{
    struct study study;
    struct pool pool;
    struct error error;
    static const double etas[] = {1.5, 2, 0};
    if (plan(&study, &pool, "sod", "", "eta=1.5,2,0.5", 3, &error)) fail_msg("%s", error.message);
    assert_int_equal(pool.count, 2 * LEVELS * 3);
    for (size_t c = 0; c < 2; c++) {
        assert_false(study.results[c].excluded);
        assert_true(settings_real(&study.results[c].settings, SETTING_n) == 400);
        assert_true(study.results[c].scheme.eta == etas[c]);
        for (size_t l = 0; l < LEVELS; l++)
            for (size_t r = 0; r < 3; r++) {
                const size_t k = (c * LEVELS + l) * 3 + r;
                const struct run *run = &study.runs[k];
                const struct pool_job *job = &pool.jobs[study.jobs[k]];
                char name[32], *key = run_job_key(run, "run", &error);
                assert_true(real_of(run, SETTING_n) ==
                            (double)study_neighbour(ladder[l], 1, 3, 1, r));
                assert_true(real_of(run, SETTING_eta) == etas[c]);
                assert_true(real_of(run, SETTING_seed) == 1);
                snprintf(name, sizeof name, "sod, n = %zu", study_neighbour(ladder[l], 1, 3, 1, r));
                assert_string_equal(job->name, name);
                assert_string_equal(job->key, key);
                assert_true(job->weight == run_job_weight(run) && job->context == run);
                free(key);
            }
    }
    assert_true(study.results[2].excluded);
    assert_non_null(strstr(study.results[2].message, "eta = 0.5"));
    study_free(&study);
    assert_true(!study.results && !study.runs && !study.jobs);
    pool_free(&pool);
}

/* If the start is random, replicates have other seeds, and the level's own number. */
TEST(seeds)
{
    struct study study;
    struct pool pool;
    struct error error;
    if (plan(&study, &pool, "sod", "jitter=0.1 seed=7", NULL, 3, &error))
        fail_msg("%s", error.message);
    for (size_t k = 0; k < LEVELS * 3; k++) {
        assert_true(real_of(&study.runs[k], SETTING_n) == (double)ladder[k / 3]);
        assert_true(real_of(&study.runs[k], SETTING_seed) == 7 + (double)(k % 3));
    }
    study_free(&study);
    pool_free(&pool);
}

/* Replicates span 5 % of n, alternately above and below; all are above if fewer than 4 particles
 * would be left below. */
TEST(numbers)
{
    static const struct {
        size_t n, replicates, of[9];
    } rows[] = {
        {400, 9, {400, 403, 397, 406, 394, 409, 391, 412, 388}}, /* 2.5 is rounded up */
        {390, 9, {390, 392, 388, 394, 386, 396, 384, 398, 382}},
        {200, 4, {200, 203, 197, 206}},
        {100, 2, {100, 105}},
        {8, 9, {8, 9, 7, 10, 6, 11, 5, 12, 4}},
        {7, 9, {7, 8, 9, 10, 11, 12, 13, 14, 15}},
        {6, 4, {6, 7, 5, 8}},
        {5, 4, {5, 6, 7, 8}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (size_t r = 0; r < rows[k].replicates; r++)
            assert_int_equal(study_neighbour(rows[k].n, 1, rows[k].replicates, 1, r),
                             rows[k].of[r]);
    static const size_t rows_2d[] = {144, 169, 121, 196},
                        rows_3d[] = {64, 125, 27, 216, 8, 343, 1, 512, 0, 729, 0};
    for (size_t r = 0; r < 4; r++) assert_int_equal(study_neighbour(144, 2, 4, 1, r), rows_2d[r]);
    for (size_t r = 0; r < 11; r++) assert_int_equal(study_neighbour(64, 3, 11, 1, r), rows_3d[r]);
    assert_int_equal(study_neighbour(64, 3, 1, 1, 0), 64);
    assert_int_equal(study_neighbour(100, 1, 5, 4, 3), 108);
    assert_int_equal(study_neighbour(400, 1, 5, 4, 4), 390); /* 5 % of n are enough */
    /* 5000.499 is rounded down */
    assert_int_equal(study_neighbour(6300629, 1, 64, 1, 1), 6300629 + 5000);
    assert_int_equal(study_neighbour(200, 1, 1, 1, 0), 200);
    assert_int_equal(study_neighbour(200, 1, 1, 1, 5), 200);
}

TEST(how_many_replicates)
{
    static const struct {
        const char *name, *key;
        size_t replicates;
    } rows[] = {{"sod", "n=100", 9},
                {"sound_wave", "n=100", 1},
                {"sod", "jitter=0.1", 3},
                {"sod_2d", "n=100", 1},
                {"gresho", "n=100", 1},
                {"sod_2d", "lattice=glass", 3},
                {"sound_wave_2d", "jitter=0.1", 3}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct run_settings settings = keyed_case(rows[k].name, rows[k].key);
        assert_int_equal(study_replicates(&settings), rows[k].replicates);
        assert_true(settings_random_start(&settings.settings) == (rows[k].replicates == 3));
    }
}

static json_t *key_of(const struct run *run, const char *kind)
{
    struct error error = {0};
    char *text = run_job_key(run, kind, &error);
    assert_non_null(text);
    assert_int_equal(error.status, STATUS_OK);
    json_t *key = json_loads(text, 0, NULL);
    assert_non_null(key);
    char *again = json_dumps(key, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    assert_string_equal(text, again); /* one form for all spellings */
    free(again);
    free(text);
    return key;
}

/* A key contains everything that determines a result, and nothing else; for a file, its
 * contents. */
TEST(keys)
{
    struct run run = keyed_run("sod", "eta=2.3849999999999998");
    for (int any = 0; any < 2; any++) {
        run.asked.any_window = any;
        json_t *key = key_of(&run, "other");
        json_t *want = json_pack("{s:s, s:s, s:s, s:i, s:b, s:o}", "kind", "other", "case", "sod",
                                 "title", run.asked.file.title, "dimension", 1, "any_window", any,
                                 "settings", settings_json(&run.settings));
        assert_true(json_equal(key, want));
        json_decref(key);
        json_decref(want);
    }
    char folder[] = "study_plan.XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/p.csv", folder);
    run = keyed_run("gresho", "");
    snprintf(run.settings.file, sizeof run.settings.file, "%s", path);
    char bytes[9000];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (char)('0' + i * i % 71);
    static const size_t lengths[] = {0, 1, 4097, sizeof bytes}; /* 4096 are read at once */
    for (size_t k = 0; k < 4; k++) {
        const size_t n = lengths[k];
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(bytes, 1, n, file), n);
        fclose(file);
        json_t *key = key_of(&run, "run");
        assert_int_equal(json_integer_value(json_object_get(key, "content")),
                         (json_int_t)cache_hash(CACHE_HASH, bytes, n));
        json_decref(key);
    }
    unlink(path);
    strcpy(run.settings.file, "p");
    json_t *key = key_of(&run, "run"); /* a file that does not exist */
    assert_true(json_is_integer(json_object_get(key, "content")));
    assert_int_equal(json_integer_value(json_object_get(key, "content")), 0);
    json_decref(key);
    rmdir(folder);
}

TEST(weights)
{
    struct run run = keyed_run("sod", "n=1000");
    near_relative(run_job_weight(&run), 0.052, 1e-14);
    run = keyed_run("gresho", "n=100^2");
    near_relative(run_job_weight(&run), 0.002 + 10, 1e-14);
    run = keyed_run("rest_3d", "n=10^3");
    near_relative(run_job_weight(&run), 0.002 + 1e-5 * 1e4, 1e-13);
}

/* A run whose profile is in the pool is not added; nor is a second one with the same key. */
TEST(runs_in_the_pool_are_not_repeated)
{
    struct error error;
    struct pool pool = {0};
    size_t job[3];
    struct run run = keyed_run("sod", "n=100"), other = keyed_run("sod", "n=200");
    char *key = run_job_key(&run, RUN_JOB_PROFILE, &error);
    assert_int_equal(pool_add(&pool, "another", "another", 1, NULL, NULL), 0);
    assert_int_equal(pool_add(&pool, "with its profile", key, 1, NULL, NULL), 1);
    free(key);
    assert_int_equal(run_job_add(&pool, &run, &job[0], &error), STATUS_OK);
    for (int k = 1; k < 3; k++)
        assert_int_equal(run_job_add(&pool, &other, &job[k], &error), STATUS_OK);
    assert_true(job[0] == 1 && job[1] == 2 && job[2] == 2);
    assert_int_equal(pool.count, 3);
    pool_free(&pool);
}

/* The process of a run returns its document, or the reason for its failure. */
TEST(run_in_a_process)
{
    struct error error;
    struct pool pool = {0};
    const struct pool_settings settings = {.jobs = 1};
    size_t job[2];
    struct run run = keyed_run("sod", "t_end=0.001"), lost = keyed_run("sod", "t_end=0.002");
    lost.settings.value[SETTING_n].real[0] = 0x1p53; /* more than the memory */
    assert_int_equal(run_job_add(&pool, &run, &job[0], &error), STATUS_OK);
    assert_int_equal(run_job_add(&pool, &lost, &job[1], &error), STATUS_OK);
    assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
    const struct pool_job *done = &pool.jobs[job[0]], *failed = &pool.jobs[job[1]];
    assert_int_equal(done->error.status, STATUS_OK);
    assert_string_equal(value_text(done->document, "command"), "run");
    assert_string_equal(value_text(done->document, "case"), "sod");
    assert_int_equal(failed->error.status, STATUS_ENVIRONMENT);
    assert_true(failed->error.message[0] && !failed->document && !failed->crashed);
    pool_free(&pool);
}

/* A value that a key no longer allows. */
TEST(values_no_longer_allowed)
{
    struct study study;
    struct pool pool;
    struct error error;
    if (plan(&study, &pool, "sod", "", "eta=1.5,2", 1, &error)) fail_msg("%s", error.message);
    pool_free(&pool);
    study_free(&study);
    strcpy(study.sweep.keys[0].values[1], "wide");
    assert_int_equal(study_plan(&study, &pool, &error), STATUS_BAD_INPUT);
    assert_non_null(strstr(error.message, "wide"));
    pool_free(&pool);
    study_free(&study);
}

static void refused(const char *keys_of, const char *vary, const char *why)
{
    struct study study;
    struct pool pool;
    struct error error;
    assert_int_equal(plan(&study, &pool, "sod", keys_of, vary, 1, &error), STATUS_BAD_INPUT);
    if (strncmp(error.message, why, strlen(why)) != 0)
        fail_msg("'%s', not '%s'", error.message, why);
    study_free(&study);
    pool_free(&pool);
}

TEST(impossible_studies_are_refused)
{
    refused("eta=0.5", NULL, "eta = 0.5");
    refused("", "eta=0.5,0.6", "no combination of --vary is allowed: eta = 0.5");
    refused("t_end=5", NULL, "t_end=5: ");
    refused("t_end=5", "eta=0.5,1.5", "t_end=5: ");
    /* the fault of a single combination */
    refused("", "eta=0.5", "eta = 0.5: h = eta");
}
