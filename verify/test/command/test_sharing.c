/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests `--shard`, `--list`, `--cache` and `--engine`: the exit status of a share for each outcome
 * of its computations, shares computed and joined in any order, the final plain call, which
 * computes what is missing, and wrong options. */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#include <fcntl.h>

#include "sample_jobs.h"
/* the options themselves, because the cluster is replaced */
#define slurm_compute compute_planted
#include "../../command/sharing.c"

enum { N = 7, SHARES = 3 };

static const struct command_option list[] = {
    {"jobs", "J", ""}, {"force", NULL, ""}, SHARING_OPTIONS, {NULL, NULL, NULL}};
static const struct command command = {.name = "converge", .synopsis = "CASE", .options = list};

/* How a computation shall end. */
struct planned {
    enum status status;
    enum { ENDS, IS_KILLED, LEAVES } how;
};

static struct call {
    struct job_folder folder;
    struct planned planned[N];
    const char *values[sizeof list / sizeof *list];
    struct options options;
    struct sharing sharing;
    struct pool pool;
    struct error error;
    char said[4000]; /* standard output, then standard error */
    bool whole;
} call;

static enum status end_as_planned(const void *context, json_t **document, struct error *error)
{
    const struct planned *planned = context;
    if (planned->how == IS_KILLED) raise(SIGKILL);
    if (planned->how == LEAVES) _exit(0);
    *document = json_pack("{s:i}", "number", (int)(planned - call.planned));
    return planned->status ? error_set(error, planned->status, "reason %d", (int)planned->status)
                           : STATUS_OK;
}

static void set(const char *name, const char *value)
{
    for (size_t i = 0; list[i].name; i++)
        if (strcmp(list[i].name, name) == 0) call.values[i] = value;
}

static int begin(void **state)
{
    (void)state;
    call = (struct call){
        .options = {
            .command = &command, .threads = 1, .speak = 1, .quiet = 1, .values = call.values}};
    job_folder_make(&call.folder);
    return 0;
}

static int end(void **state)
{
    (void)state;
    job_folder_clear(&call.folder);
    return 0;
}

static void fill_planned(void)
{
    call.pool = (struct pool){0};
    for (int i = 0; i < N; i++) {
        char name[32];
        snprintf(name, sizeof name, "task %d", i);
        assert_int_equal(pool_add(&call.pool, name, name, N - i, end_as_planned, &call.planned[i]),
                         i);
    }
}

static void listen_to(int said[2], int usual[2])
{
    fflush(NULL);
    for (int f = 0; f < 2; f++) {
        char path[100];
        snprintf(path, sizeof path, "%s/said%d", call.folder.cache_folder, f);
        said[f] = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
        usual[f] = dup(f + 1);
        dup2(said[f], f + 1);
    }
}

static void listened(const int said[2], const int usual[2])
{
    size_t length = 0;
    fflush(NULL);
    for (int f = 0; f < 2; f++) {
        dup2(usual[f], f + 1);
        const ssize_t n = pread(said[f], call.said + length, sizeof call.said - 1 - length, 0);
        length += n > 0 ? (size_t)n : 0;
        close(said[f]), close(usual[f]);
    }
    call.said[length] = '\0';
}

/* Reads the options and runs the pool, which the caller frees. shard: NULL for a plain call. */
static enum status run_share(const char *shard)
{
    int said[2], usual[2];
    set("cache", call.folder.cache_folder);
    set("shard", shard);
    call.error = (struct error){0};
    assert_int_equal(sharing_take(&call.sharing, &call.options, 1, NULL, &call.error), STATUS_OK);
    fill_planned();
    listen_to(said, usual);
    const enum status status =
        sharing_run(&call.sharing, &call.pool, &call.options, &call.whole, &call.error);
    listened(said, usual);
    assert_int_equal(status, call.error.status);
    assert_int_equal(call.whole, shard == NULL);
    return status;
}

static const struct {
    struct planned planned;
    enum status of_share; /* how a share ends that has one computation of this outcome */
    bool kept;
    const char *message;
} outcomes[] = {
    {{STATUS_OK, ENDS}, STATUS_OK, true, ""},
    {{STATUS_CHECK_FAILED, ENDS}, STATUS_OK, true, ""},
    {{STATUS_BAD_INPUT, ENDS}, STATUS_BAD_INPUT, false, "reason 2"},
    {{STATUS_BROKE_DOWN, ENDS}, STATUS_OK, true, ""},
    {{STATUS_ENVIRONMENT, ENDS}, STATUS_ENVIRONMENT, false, "reason 4"},
    {{STATUS_OK, IS_KILLED}, STATUS_BROKE_DOWN, false, "its process was ended by signal 9"},
    {{STATUS_OK, LEAVES}, STATUS_ENVIRONMENT, false, "its process gave no result"},
};
enum { OUTCOMES = sizeof outcomes / sizeof *outcomes };

/* One share has one computation of each outcome. The other shares are not affected. */
TEST(exit_status_of_a_share)
{
    for (int k = 0; k < OUTCOMES; k++)
        for (int i = k % 2; i < N; i += 3) {
            char shard[16], text[100];
            end(NULL), begin(NULL);
            call.planned[i] = outcomes[k].planned;
            size_t mine = 0;
            for (int s = 1; s <= SHARES; s++) {
                snprintf(shard, sizeof shard, "%d/%d", s, SHARES);
                const enum status status = run_share(shard);
                size_t has = 0;
                for (int j = 0; j < N; j++) has += !call.pool.jobs[j].elsewhere;
                mine += has;
                if (call.pool.jobs[i].elsewhere || !outcomes[k].of_share) {
                    assert_int_equal(status, STATUS_OK);
                    snprintf(text, sizeof text,
                             "share %d of 3: %zu of 7 computations, 0 of them found in ", s, has);
                    assert_int_equal(strncmp(call.said, text, strlen(text)), 0);
                } else {
                    assert_int_equal(status, outcomes[k].of_share);
                    snprintf(text, sizeof text, "task %d: %s", i,
                             outcomes[k].planned.how == ENDS ? outcomes[k].message : "task");
                    assert_int_equal(strncmp(call.error.message, text, strlen(text)), 0);
                    assert_non_null(strstr(call.error.message, outcomes[k].message));
                    assert_string_equal(call.said, "");
                }
                pool_free(&call.pool);
            }
            assert_int_equal(mine, N);
            char key[32];
            snprintf(key, sizeof key, "task %d", i);
            assert_int_equal(cache_has(&call.folder.cache, key), outcomes[k].kept);
        }
}

/* The plain call that follows shows every outcome as if one machine had computed everything. */
TEST(shares_in_every_order)
{
    static const int orders[][SHARES] = {{1, 2, 3}, {1, 3, 2}, {2, 1, 3}, {2, 3, 1}, {3, 1, 2},
                                         {3, 2, 1}, {2, 2, 1}, {1, 0, 0}, {0, 0, 3}, {0, 0, 0}};
    for (size_t o = 0; o < sizeof orders / sizeof *orders; o++) {
        size_t there = 0;
        end(NULL), begin(NULL);
        for (int i = 0; i < N; i++) call.planned[i] = outcomes[i % OUTCOMES].planned;
        for (int s = 0; s < SHARES; s++) {
            char shard[16];
            if (!orders[o][s]) continue; /* missing */
            snprintf(shard, sizeof shard, "%d/%d", orders[o][s], SHARES);
            run_share(shard);
            pool_free(&call.pool);
        }
        for (int i = 0; i < N; i++) {
            char key[32];
            snprintf(key, sizeof key, "task %d", i);
            there += cache_has(&call.folder.cache, key);
        }
        assert_int_equal(run_share(NULL), STATUS_OK);
        assert_string_equal(call.said, "");
        assert_int_equal(call.pool.found, there);
        for (int i = 0; i < N; i++) {
            const struct pool_job *job = &call.pool.jobs[i];
            const struct planned *planned = &outcomes[i % OUTCOMES].planned;
            assert_true(job->done && !job->elsewhere);
            assert_int_equal(job->crashed, planned->how == IS_KILLED);
            assert_int_equal(job->error.status, planned->how == IS_KILLED ? STATUS_BROKE_DOWN
                                                : planned->how == LEAVES  ? STATUS_ENVIRONMENT
                                                                          : planned->status);
            assert_int_equal(job->document != NULL, planned->how == ENDS);
        }
        pool_free(&call.pool);
    }
}

/* Damaged entries and a cache that cannot be written are reported; for a share they are errors. */
TEST(damaged_and_unwritable_caches)
{
    char path[CACHE_PATH_MAX];
    end(NULL), begin(NULL);
    assert_int_equal(run_share("1/1"), STATUS_OK);
    pool_free(&call.pool);
    cache_path(&call.folder.cache, "task 1", path);
    assert_int_equal(truncate(path, 20), 0);
    call.options.quiet = 0;
    assert_int_equal(run_share("1/1"), STATUS_OK);
    assert_non_null(strstr(call.said, "share 1 of 1: 7 of 7 computations, 6 of them found in "));
    assert_non_null(strstr(call.said, "sphproof: note: 1 kept results were damaged: computed "
                                      "again\n"));
    pool_free(&call.pool);
    assert_int_equal(run_share("1/1"), STATUS_OK);
    assert_non_null(strstr(call.said, "7 of them found in "));
    assert_null(strstr(call.said, "note"));
    pool_free(&call.pool);
    /* a file stands where the folder of an entry should be */
    unlink(path);
    *strrchr(path, '/') = '\0';
    assert_int_equal(rmdir(path), 0);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    for (int quiet = 0; quiet < 2; quiet++) {
        call.options.quiet = quiet;
        assert_int_equal(run_share("1/1"), STATUS_ENVIRONMENT);
        assert_true(strlen(call.error.message) > 10);
        assert_string_equal(call.said, "");
        pool_free(&call.pool);
        assert_int_equal(run_share(NULL), STATUS_OK); /* the plain call computes the result */
        assert_int_equal(strncmp(call.said, "sphproof: note: ", 16) == 0, !quiet);
        pool_free(&call.pool);
    }
    unlink(path);
}

static struct {
    enum status status;
    int jobs;
} planted;

enum status compute_planted(const struct slurm_work *work, struct error *error)
{
    assert_ptr_equal(work->options, &call.options);
    assert_ptr_equal(work->pool, &call.pool);
    assert_ptr_equal(work->cache, &call.sharing.cache);
    assert_int_equal(work->jobs, planted.jobs);
    assert_int_equal(work->tasks, 9);
    assert_string_equal(work->progress->what, "converge");
    work->progress->what = "tasks";
    work->progress->spoke = 1, work->progress->terminal = true; /* the progress line must go */
    return planted.status ? error_set(error, planted.status, "no tasks") : STATUS_OK;
}

/* A cluster receives all settings; results that it lacks are computed here unless it fails. */
TEST(clusters)
{
    static const char *const jobs[] = {NULL, "1", "3"};
    for (int k = 0; k < 3; k++)
        for (enum status s = STATUS_OK; s <= STATUS_ENVIRONMENT; s++) {
            int said[2], usual[2];
            end(NULL), begin(NULL);
            set("cache", call.folder.cache_folder), set("jobs", jobs[k]);
            assert_int_equal(sharing_take(&call.sharing, &call.options, 5, NULL, &call.error),
                             STATUS_OK);
            call.sharing.slurm = true, call.sharing.tasks = 9;
            planted.status = s, planted.jobs = k == 2 ? 3 : 1;
            fill_planned();
            listen_to(said, usual);
            assert_int_equal(
                sharing_run(&call.sharing, &call.pool, &call.options, &call.whole, &call.error), s);
            listened(said, usual);
            assert_int_equal(call.whole, !s);
            assert_string_equal(call.said, "\r\033[K");
            assert_string_not_equal(call.sharing.progress.what, "tasks");
            assert_string_equal(call.error.message, s ? "no tasks" : "");
            for (int i = 0; i < N; i++) assert_int_equal(call.pool.jobs[i].done, !s);
            pool_free(&call.pool);
        }
}

/* Nothing is printed where speak is off. */
TEST(silent_share)
{
    end(NULL), begin(NULL);
    call.options.speak = 0;
    assert_int_equal(run_share("2/3"), STATUS_OK);
    assert_string_equal(call.said, "");
    pool_free(&call.pool);
}

/* --list prints each computation, the share that it belongs to, and whether it is kept. */
TEST(list_of_computations)
{
    static const char *const shards[] = {NULL, "1/3", "2/3", "3/3"};
    int shares[N], said[2], usual[2];
    end(NULL), begin(NULL);
    fill_planned();
    assert_int_equal(pool_divide(&call.pool, SHARES, shares, &call.error), STATUS_OK);
    pool_free(&call.pool);
    assert_int_equal(run_share("2/3"), STATUS_OK);
    pool_free(&call.pool);
    set("list", "");
    for (size_t k = 0; k < 4; k++)
        for (int there = 0; there < 2; there++) {
            char expected[1000] = "";
            set("shard", shards[k]);
            set("cache", there ? call.folder.cache_folder : k ? "nowhere" : NULL);
            assert_int_equal(sharing_take(&call.sharing, &call.options, 1, NULL, &call.error),
                             STATUS_OK);
            assert_true(call.sharing.list);
            fill_planned();
            listen_to(said, usual);
            call.whole = true;
            assert_int_equal(
                sharing_run(&call.sharing, &call.pool, &call.options, &call.whole, &call.error),
                STATUS_OK);
            listened(said, usual);
            assert_false(call.whole);
            for (int i = 0; i < N; i++) {
                if (k && shares[i] != (int)k) continue;
                snprintf(expected + strlen(expected), sizeof expected - strlen(expected),
                         "%d\t%d\t%s\ttask %d\n", N - i, k ? shares[i] : 1,
                         there && shares[i] == 2 ? "kept" : "-", i);
            }
            assert_string_equal(call.said, expected);
            pool_free(&call.pool);
        }
    assert_int_equal(access("nowhere", F_OK), -1); /* listing makes no folder */
}

/* ---- options ---- */

TEST(invalid_options)
{
    static const struct {
        const char *names[3], *values[3];
        const char *message; /* NULL: valid */
    } rows[] = {
        {{"jobs"}, {"1"}, NULL},
        {{"jobs"}, {"1024"}, NULL},
        {{"jobs"}, {"0"}, "converge: --jobs '0': allowed: an integer from 1 to 1024"},
        {{"jobs"}, {"1025"}, "--jobs '1025'"},
        {{"jobs"}, {"2.5"}, "--jobs '2.5'"},
        {{"jobs"}, {"x"}, "--jobs 'x'"},
        {{"jobs"}, {""}, "--jobs ''"},
        {{"shard", "cache"}, {"1/1", "c"}, NULL},
        {{"shard", "cache"}, {"3/3", "c"}, NULL},
        {{"shard", "cache"}, {"1/1000000", "c"}, NULL},
        {{"shard", "cache"},
         {"1/1000001", "c"},
         "converge: --shard '1/1000001': allowed: I/N with 1 <= I <= N <= 1000000, as 3/8"},
        {{"shard", "cache"}, {"0/3", "c"}, "--shard '0/3'"},
        {{"shard", "cache"}, {"-1/3", "c"}, "--shard '-1/3'"},
        {{"shard", "cache"}, {"4/3", "c"}, "--shard '4/3'"},
        {{"shard", "cache"}, {"1/3x", "c"}, "--shard '1/3x'"},
        {{"shard", "cache"}, {"1", "c"}, "--shard '1'"},
        {{"shard", "cache"}, {"", "c"}, "--shard ''"},
        {{"shard", "cache"}, {"1/0", "c"}, "--shard '1/0'"},
        {{"shard"}, {"1/3"}, "converge: --shard needs --cache DIR: there the shares meet"},
        {{"shard", "cache", "force"},
         {"1/3", "c", ""},
         "converge: --shard and --force exclude each other: begin with an empty cache"},
        {{"cache", "force"}, {"c", ""}, NULL},
        {{"engine"}, {"local"}, NULL},
        {{"engine"}, {"slum"}, "slurm"},
        {{"engine"},
         {"slurm"},
         "converge: --engine slurm needs --cache DIR, which all machines see"},
        {{"engine", "cache"}, {"slurm", "c"}, NULL},
        {{"engine", "cache", "force"},
         {"slurm", "c", ""},
         "converge: --engine slurm and --force exclude each other"},
        {{"engine", "cache", "shard"},
         {"slurm", "c", "1/2"},
         "converge: --engine slurm and --shard exclude each other"},
        {{"engine", "cache", "engine-tasks"}, {"slurm", "c", "1"}, NULL},
        {{"engine", "cache", "engine-tasks"}, {"slurm", "c", "1000"}, NULL},
        {{"engine", "cache", "engine-tasks"},
         {"slurm", "c", "1001"},
         "converge: --engine-tasks '1001': allowed: an integer from 1 to 1000"},
        {{"engine", "cache", "engine-tasks"}, {"slurm", "c", "0"}, "--engine-tasks '0'"},
        {{"engine", "cache", "engine-tasks"}, {"slurm", "c", "x"}, "--engine-tasks 'x'"},
        {{"engine", "cache", "engine-options"}, {"slurm", "c", "-p x"}, NULL},
        {{"engine-tasks"},
         {"3"},
         "converge: --engine-options and --engine-tasks need --engine slurm"},
        {{"engine-options"},
         {"-p x"},
         "converge: --engine-options and --engine-tasks need --engine slurm"},
        {{"engine-options", "engine"}, {"-p x", "local"}, "need --engine slurm"},
        {{"only-build", "cache"}, {"0123", "c"}, ", not 0123: another program, C library"},
        {{"only-build"}, {"0123"}, "converge: --only-build needs --cache DIR"},
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        struct sharing sharing;
        end(NULL), begin(NULL);
        for (int i = 0; i < 3 && rows[r].names[i]; i++)
            set(rows[r].names[i],
                strcmp(rows[r].values[i], "c") ? rows[r].values[i] : call.folder.cache_folder);
        const bool build = rows[r].names[1] && strcmp(rows[r].names[0], "only-build") == 0;
        call.error = (struct error){0};
        const enum status status = sharing_take(&sharing, &call.options, 5, NULL, &call.error);
        if (!rows[r].message) {
            assert_int_equal(status, STATUS_OK);
            continue;
        }
        assert_int_equal(status, build ? STATUS_ENVIRONMENT : STATUS_BAD_INPUT);
        assert_int_equal(call.error.status, status);
        if (!strstr(call.error.message, rows[r].message)) print_error("%s\n", call.error.message);
        assert_non_null(strstr(call.error.message, rows[r].message));
    }
}

/* The values that valid options give. */
TEST(valid_options)
{
    struct sharing sharing;
    end(NULL), begin(NULL);
    assert_int_equal(sharing_take(&sharing, &call.options, 5, NULL, &call.error), STATUS_OK);
    assert_int_equal(sharing.pool.jobs, 5);
    assert_true(sharing.pool.again); /* breakdowns are tried again where everything is computed */
    assert_true(!sharing.list && !sharing.pool.cache && !sharing.pool.share.of && !sharing.tasks);
    assert_false(sharing.slurm);
    assert_int_equal(sharing_take(&sharing, &call.options, 0, NULL, &call.error), STATUS_OK);
    assert_int_equal(sharing.pool.jobs, 1);
    set("jobs", "3"), set("shard", "2/7"), set("cache", "elsewhere");
    char build[CACHE_BUILD_MAX];
    cache_build(build);
    set("only-build", build);
    assert_int_equal(
        sharing_take(&sharing, &call.options, 5, call.folder.cache_folder, &call.error),
        STATUS_OK); /* the command's own folder takes precedence over --cache */
    assert_int_equal(sharing.pool.jobs, 3);
    assert_true(sharing.pool.share.number == 2 && sharing.pool.share.of == 7);
    assert_false(sharing.pool.again);
    assert_true(sharing.pool.cache == &sharing.cache && !sharing.cache.force);
    assert_string_equal(sharing.cache.folder, call.folder.cache_folder);
    assert_int_equal(access("elsewhere", F_OK), -1);
    set("shard", NULL), set("engine", "slurm"), set("engine-tasks", "9");
    assert_int_equal(
        sharing_take(&sharing, &call.options, 5, call.folder.cache_folder, &call.error), STATUS_OK);
    assert_true(sharing.slurm && !sharing.pool.again);
    assert_int_equal(sharing.tasks, 9);
    set("engine", NULL), set("engine-tasks", NULL), set("force", "");
    assert_int_equal(
        sharing_take(&sharing, &call.options, 5, call.folder.cache_folder, &call.error), STATUS_OK);
    assert_true(sharing.cache.force);
}

TEST_BETWEEN(begin, end);
