/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests parallel computations: results do not depend on the number of processes or on the cache;
 * order, number at once and shares; and messages about those that fail. */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#ifdef __linux__
#include <malloc.h>
#endif
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

#include "output.h"
#include "sample_jobs.h"

TEST(any_number_of_processes)
{
    struct job_folder folder;
    struct pool one, two, kept;
    struct task tasks[3][JOBS] = {0};
    job_folder_make(&folder);
    tasks[0][2].kind = tasks[1][2].kind = tasks[2][2].kind = BROKEN;
    fill(&one, tasks[0], &folder, JOBS);
    fill(&two, tasks[1], &folder, JOBS);
    fill(&kept, tasks[2], &folder, JOBS);
    assert_int_equal(run(&one, NULL, 1), STATUS_OK);
    assert_int_equal(run(&two, &folder.cache, 3), STATUS_OK);
    assert_int_equal(computed(&folder), 2 * JOBS);
    assert_int_equal(run(&kept, &folder.cache, 2), STATUS_OK);
    assert_int_equal(computed(&folder), 2 * JOBS);
    assert_int_equal(kept.found, JOBS);
    assert_int_equal(two.found, 0);
    same_results(&one, &two);
    same_results(&one, &kept);
    assert_int_equal(one.jobs[2].error.status, STATUS_BROKE_DOWN);
    assert_int_equal(json_integer_value(json_object_get(one.jobs[5].document, "number")), 5);
    struct cache force = folder.cache;
    force.force = true;
    pool_free(&kept);
    fill(&kept, tasks[2], &folder, JOBS);
    assert_int_equal(run(&kept, &force, 2), STATUS_OK);
    assert_int_equal(computed(&folder), 3 * JOBS);
    same_results(&one, &kept);
    pool_free(&one);
    pool_free(&two);
    pool_free(&kept);
    job_folder_clear(&folder);
}

/* If results cannot be stored, they are still returned, and the pool gives the reason. */
TEST(full_disk)
{
    struct job_folder folder;
    struct pool pool;
    struct task tasks[2] = {0};
    job_folder_make(&folder);
    struct cache gone = folder.cache;
    snprintf(gone.folder, sizeof gone.folder, "/dev/null/missing");
    fill(&pool, tasks, &folder, 2);
    assert_int_equal(run(&pool, &gone, 2), STATUS_OK);
    assert_non_null(pool.jobs[0].document);
    assert_non_null(strstr(pool.note, "/dev/null"));
    pool_free(&pool);
    job_folder_clear(&folder);
}

/* ---- how jobs are made ---- */

enum { SLOTS = 160 };

/* Shared memory of the processes. */
struct board {
    int running, most, count, order[SLOTS];
};
static struct board *board;

struct script {
    int number;
    enum status status;
    enum { NOTHING, WITH_DOCUMENT, LEAVES, LEAVES_BADLY, FLUSHES } kind;
    int ms;       /* duration of the job */
    int together; /* the job first waits until this many have run at once, 20 s at most */
};

static enum status obey(const void *context, json_t **document, struct error *error)
{
    const struct script *script = context;
    const int now = __atomic_add_fetch(&board->running, 1, __ATOMIC_SEQ_CST);
    for (int most = board->most; now > most;)
        if (__atomic_compare_exchange_n(&board->most, &most, now, false, __ATOMIC_SEQ_CST,
                                        __ATOMIC_SEQ_CST))
            break;
    board->order[__atomic_fetch_add(&board->count, 1, __ATOMIC_SEQ_CST)] = script->number;
    const struct timespec pause = {script->ms / 1000, script->ms % 1000 * 1000000L},
                          tick = {0, 1000000};
    for (int k = 0; k < 20000 && __atomic_load_n(&board->most, __ATOMIC_SEQ_CST) < script->together;
         k++)
        nanosleep(&tick, NULL);
    nanosleep(&pause, NULL);
    __atomic_sub_fetch(&board->running, 1, __ATOMIC_SEQ_CST);
    if (script->kind == LEAVES) _exit(0);
    if (script->kind == FLUSHES) fflush(NULL);
    if (script->kind == LEAVES_BADLY) _exit(1);
    if (script->kind == WITH_DOCUMENT) *document = json_pack("{s:i}", "number", script->number);
    error_set(error, script->status, "said by %d", script->number);
    return script->status;
}

/* Adds n jobs with these weights. */
static void add(struct pool *pool, struct script *script, size_t n, const double *weights)
{
    *pool = (struct pool){0};
    for (size_t i = 0; i < n; i++) {
        char name[32];
        script[i].number = (int)i;
        snprintf(name, sizeof name, "job %zu", i);
        assert_int_equal(pool_add(pool, name, name, weights ? weights[i] : 1, obey, &script[i]), i);
    }
}

/* Before all tests: a process that runs a job must not return here. If it did, this process would
 * end in the middle of a test without a message. */
static int begin(void **state)
{
    (void)state;
    board = mmap(NULL, sizeof *board, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (board == MAP_FAILED) return 1;
    const pid_t child = fork();
    if (child == 0) {
        struct pool pool;
        struct script script = {0};
        add(&pool, &script, 1, NULL);
        run(&pool, NULL, 1);
        _exit(42);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return !WIFEXITED(status) || WEXITSTATUS(status) != 42;
}

/* Bytes that malloc has in use; 0 where that is unknown. */
static size_t bytes_in_use(void)
{
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
    return mallinfo2().uordblks;
#else
    return 0;
#endif
}

/* Names, keys and weights are as given, for any number of jobs; a key has one job. */
TEST(many_jobs)
{
    static struct script script[SLOTS];
    struct pool pool = {0};
    char name[32] = "none", key[32];
    const size_t before = bytes_in_use();
    assert_true(pool_find(&pool, "none") == (size_t)-1);
    for (size_t i = 0; i < SLOTS; i++) {
        snprintf(name, sizeof name, "job %zu", i);
        snprintf(key, sizeof key, "key %zu", i);
        assert_int_equal(pool_add(&pool, name, key, (double)i, obey, &script[i]), i);
        assert_int_equal(pool.count, i + 1);
    }
    for (size_t i = 0; i < SLOTS; i++) {
        const struct pool_job *job = &pool.jobs[i];
        snprintf(name, sizeof name, "job %zu", i);
        snprintf(key, sizeof key, "key %zu", i);
        assert_string_equal(job->name, name);
        assert_true(job->weight == (double)i && job->compute == obey && job->context == &script[i]);
        assert_true(!job->done && !job->cached && !job->crashed && !job->elsewhere);
        assert_true(pool_find(&pool, key) == i);
        assert_string_equal(job->key, key);
        assert_int_equal(pool_add(&pool, "again", key, 7, obey, NULL), i);
    }
    /* a key that is not UTF-8 cannot be found again */
    assert_true(pool_add(&pool, "job", "\xff", 1, obey, NULL) == (size_t)-1);
    assert_int_equal(pool.count, SLOTS);
    pool_free(&pool);
    assert_true(!pool.count && !pool.jobs && !pool.numbers);
    near_below((double)bytes_in_use() - (double)before, 3000); /* names and keys are freed */
}

/* ---- how they are run ---- */

/* Heavy jobs run first, and equal ones in their order, with no more at once than requested. */
TEST(order_of_jobs)
{
    enum { N = 9 };
    static const double weights[N] = {2, 5, 1, 5, 3, 2, 8, 3, 1};
    static const int order[N] = {6, 1, 3, 4, 7, 0, 5, 2, 8};
    struct pool pool;
    for (int jobs = 1; jobs <= 3; jobs++) {
        struct script script[N] = {{0}};
        *board = (struct board){0};
        for (int i = 0; i < N; i++) script[i].ms = jobs == 1 ? 0 : 40, script[i].together = jobs;
        add(&pool, script, N, weights);
        assert_int_equal(run(&pool, NULL, jobs), STATUS_OK);
        assert_int_equal(board->count, N);
        assert_int_equal(board->most, jobs);
        for (int i = 0; i < N && jobs == 1; i++) assert_int_equal(board->order[i], order[i]);
        for (int i = 0; i < N; i++) assert_true(pool.jobs[i].done && !pool.jobs[i].cached);
        pool_free(&pool);
    }
}

/* A result is kept whatever its status; bad input and environment errors are not results. */
TEST(results_that_are_kept)
{
    static const enum status statuses[] = {STATUS_OK, STATUS_CHECK_FAILED, STATUS_BAD_INPUT,
                                           STATUS_BROKE_DOWN, STATUS_ENVIRONMENT};
    enum { N = 5 };
    struct job_folder folder;
    struct pool pool;
    *board = (struct board){0};
    job_folder_make(&folder);
    for (int round = 0; round < 2; round++) {
        struct script script[N] = {{0}};
        for (int i = 0; i < N; i++) {
            script[i].status = statuses[i];
            script[i].kind = i % 2 ? WITH_DOCUMENT : NOTHING;
        }
        add(&pool, script, N, NULL);
        assert_int_equal(run(&pool, &folder.cache, 2), STATUS_OK);
        assert_int_equal(pool.found, round ? 3 : 0);
        assert_true(pool.damaged == 0 && !pool.note[0]);
        for (int i = 0; i < N; i++) {
            const struct pool_job *job = &pool.jobs[i];
            char said[32] = "";
            if (statuses[i]) snprintf(said, sizeof said, "said by %d", i);
            assert_int_equal(job->error.status, statuses[i]);
            assert_string_equal(job->error.message, said);
            assert_true(job->done && !job->crashed && !job->elsewhere);
            assert_true(job->cached == (round && (i < 2 || i == 3)));
            assert_int_equal(job->document != NULL, i % 2);
            if (i % 2)
                assert_int_equal(json_integer_value(json_object_get(job->document, "number")), i);
        }
        assert_int_equal(board->count, round ? N + 2 : N);
        pool_free(&pool);
    }
    job_folder_clear(&folder);
}

/* A valid entry that is not a reply is computed again, and so is a damaged one, which is
 * counted. */
TEST(entries_that_are_missing_or_damaged)
{
    struct job_folder folder;
    struct pool pool;
    struct error error = {0};
    struct script script[2] = {{.kind = WITH_DOCUMENT}, {.kind = WITH_DOCUMENT}};
    char path[CACHE_PATH_MAX];
    *board = (struct board){0};
    job_folder_make(&folder);
    for (int round = 0; round < 3; round++) {
        add(&pool, script, 2, NULL);
        assert_int_equal(run(&pool, &folder.cache, 1), STATUS_OK);
        assert_int_equal(pool.found, round == 0 ? 0 : 1);
        assert_int_equal(pool.damaged, round == 1);
        assert_int_equal(board->count, 2 + round);
        assert_true(pool.jobs[0].document && pool.jobs[1].document);
        assert_true(pool.jobs[0].done && pool.jobs[1].done);
        pool_free(&pool);
        if (round == 0) {
            cache_path(&folder.cache, "job 0", path);
            assert_int_equal(truncate(path, 20), 0);
        } else {
            json_t *other = json_pack("{s:s}", "status", "0");
            assert_int_equal(cache_store(&folder.cache, "job 1", other, &error), STATUS_OK);
            json_decref(other);
        }
    }
    job_folder_clear(&folder);
}

/* A crash or a failure affects one job only and is not kept. */
TEST(jobs_that_crash_or_fail)
{
    struct pool pool;
    struct script script[3] = {{.kind = LEAVES}, {.kind = LEAVES_BADLY}, {.kind = WITH_DOCUMENT}};
    struct task task = {.kind = CRASHES};
    struct job_folder folder;
    job_folder_make(&folder);
    task.folder = &folder;
    for (int round = 0; round < 2; round++) {
        add(&pool, script, 3, NULL);
        assert_int_equal(pool_add(&pool, "bad one", "bad one", 1, compute, &task), 3);
        assert_int_equal(run(&pool, &folder.cache, 1), STATUS_OK);
        assert_int_equal(pool.found, round);
        for (int i = 0; i < 2; i++) {
            char said[80];
            snprintf(said, sizeof said, "job %d: its process gave no result: no memory?", i);
            assert_int_equal(pool.jobs[i].error.status, STATUS_ENVIRONMENT);
            assert_string_equal(pool.jobs[i].error.message, said);
            assert_true(pool.jobs[i].done && !pool.jobs[i].crashed && !pool.jobs[i].document);
        }
        assert_true(pool.jobs[2].document && !pool.jobs[2].error.status);
        assert_true(pool.jobs[3].crashed && pool.jobs[3].done && !pool.jobs[2].crashed);
        assert_null(pool.jobs[3].document);
        assert_int_equal(pool.jobs[3].error.status, STATUS_BROKE_DOWN);
        assert_string_equal(pool.jobs[3].error.message,
                            "bad one: its process was ended by signal 9 (Killed)");
        pool_free(&pool);
    }
    job_folder_clear(&folder);
}

/* Output still in this process's buffer before the run is written once. */
TEST(buffered_output_is_written_once)
{
    struct pool pool;
    struct script script[2] = {{.kind = FLUSHES}, {.kind = FLUSHES}};
    char folder[] = "pool.XXXXXX", path[64], text[16];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/text", folder);
    FILE *file = fopen(path, "w+");
    assert_non_null(file);
    fputs("once", file);
    add(&pool, script, 2, NULL);
    assert_int_equal(run(&pool, NULL, 1), STATUS_OK);
    pool_free(&pool);
    rewind(file);
    const size_t n = fread(text, 1, sizeof text, file);
    fclose(file);
    assert_int_equal(n, 4);
    unlink(path);
    rmdir(folder);
}

/* If no more processes can be started, running jobs are waited for, and no pipe stays open. */
TEST(too_few_file_descriptors)
{
    struct pool pool;
    struct script script[4] = {{0}};
    struct rlimit usual, few;
    struct error error = {0};
    const struct pool_settings settings = {.jobs = 4};
    output_prepare_process(); /* standard input is open, as in the program */
    const int next = dup(0);
    close(next);
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &usual), 0);
    for (int spare = 1; spare <= 3; spare++) { /* a start needs two descriptors and keeps one */
        few = usual;
        few.rlim_cur = (rlim_t)(next + spare);
        for (int i = 0; i < 4; i++) script[i].ms = 60;
        add(&pool, script, 4, NULL);
        assert_int_equal(setrlimit(RLIMIT_NOFILE, &few), 0);
        const enum status status = pool_run(&pool, &settings, &error);
        assert_int_equal(setrlimit(RLIMIT_NOFILE, &usual), 0);
        assert_int_equal(status, STATUS_ENVIRONMENT);
        char said[80];
        snprintf(said, sizeof said, "no pipe for job %d: Too many open files", spare - 1);
        assert_string_equal(error.message, said);
        for (int i = 0; i < 4; i++) assert_true(pool.jobs[i].done == (i < spare - 1));
        pool_free(&pool);
        const int after = dup(0);
        close(after);
        assert_int_equal(after, next);
    }
}

/* ---- progress reports ---- */

struct seen {
    size_t calls, done[400], total;
    char what[400][32];
    double share[400];
};

static void see(void *context, const char *what, size_t done, size_t total, double share)
{
    struct seen *seen = context;
    if (seen->calls == 400) return;
    snprintf(seen->what[seen->calls], sizeof seen->what[0], "%s", what);
    seen->done[seen->calls] = done;
    seen->share[seen->calls++] = share;
    seen->total = total;
}

/* After each job: the name of the next one, the number of jobs done, including kept ones, and the
 * share by weight of the computed ones. */
TEST(progress)
{
    enum { N = 5 };
    static const double weights[N] = {1, 4, 2, 16, 8};
    static struct seen seen;
    struct job_folder folder;
    struct pool pool;
    struct error error = {0};
    struct script script[N] = {{0}};
    job_folder_make(&folder);
    add(&pool, script, 1, weights);
    assert_int_equal(run(&pool, &folder.cache, 1), STATUS_OK); /* keeps job 0 */
    pool_free(&pool);
    const struct pool_settings settings = {
        .jobs = 1, .cache = &folder.cache, .progress = see, .progress_context = &seen};
    add(&pool, script, N, weights);
    seen = (struct seen){0};
    assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
    static const char *const names[] = {"job 3", "job 4", "job 1", "job 2"};
    static const double shares_of[] = {0, 16 / 30., 24 / 30., 28 / 30., 1};
    assert_true(seen.calls >= 4 && seen.total == N);
    size_t ends = 0;
    for (size_t k = 0; k < seen.calls; k++) {
        const size_t done = seen.done[k] - 1;
        assert_true(done < N && (k == 0 || seen.done[k] >= seen.done[k - 1]));
        assert_true(seen.share[k] == shares_of[done]);
        if (k && seen.done[k] > seen.done[k - 1]) {
            assert_string_equal(seen.what[k], names[done - 1]);
            ends++;
        }
    }
    assert_true(ends >= 3 && seen.done[seen.calls - 1] == N);
    pool_free(&pool);
    /* without weights the share is 1 */
    static const double none[2] = {0};
    add(&pool, script, 2, none);
    pool.jobs[0].key[0] = 'J', pool.jobs[1].key[0] = 'J'; /* new keys */
    seen = (struct seen){0};
    assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
    assert_true(seen.calls >= 2);
    for (size_t k = 0; k < seen.calls; k++) assert_true(seen.share[k] == 1);
    pool_free(&pool);
    /* all are kept: no report */
    add(&pool, script, N, weights);
    seen = (struct seen){0};
    assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
    assert_true(pool.found == N && seen.calls == 0);
    pool_free(&pool);
    job_folder_clear(&folder);
}

/* A long job reports a few times a second. */
TEST(progress_during_a_long_job)
{
    static struct seen seen;
    struct pool pool;
    struct error error = {0};
    struct script script = {.ms = 500};
    const struct pool_settings settings = {.jobs = 1, .progress = see, .progress_context = &seen};
    add(&pool, &script, 1, NULL);
    seen = (struct seen){0};
    assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
    assert_true(seen.calls >= 2 && seen.calls <= 12);
    assert_true(seen.done[0] == 0 && seen.share[0] == 0);
    pool_free(&pool);
}

/* ---- shares ---- */

/* The heaviest job goes to the lightest share, equal jobs in the order of keys, to the first of
 * equal shares. */
TEST(shares_by_hand)
{
    static const struct {
        const char *key;
        double weight;
    } rows[] = {{"d", 5}, {"b", 3}, {"a", 3}, {"c", 4}, {"e", 1}, {"f", 1}};
    enum { N = sizeof rows / sizeof *rows };
    struct pool pool = {0};
    struct error error = {0};
    int got[N];
    for (size_t i = 0; i < N; i++)
        assert_int_equal(pool_add(&pool, "job", rows[i].key, rows[i].weight, obey, NULL), i);
    for (int of = 1; of <= 3; of++) {
        /* computed independently, in the order d c a b e f */
        static const int order[] = {0, 3, 2, 1, 4, 5};
        double load[3] = {0};
        int want[N] = {0};
        for (size_t k = 0; k < N; k++) {
            int least = 0;
            for (int s = 1; s < of; s++) least = load[s] < load[least] ? s : least;
            load[least] += rows[order[k]].weight;
            want[order[k]] = least + 1;
        }
        memset(got, 99, sizeof got);
        assert_int_equal(pool_divide(&pool, of, got, &error), STATUS_OK);
        assert_memory_equal(got, want, sizeof got);
    }
    pool_free(&pool);
}

/* Each share computes its own jobs and leaves the others as they were. */
TEST(share_computes_its_own_jobs)
{
    enum { N = 6 };
    struct pool pool;
    struct error error = {0};
    struct script script[N] = {{0}};
    static const double weights[N] = {6, 5, 4, 3, 2, 1};
    for (int number = 1; number <= 2; number++) {
        int of[N];
        *board = (struct board){0};
        add(&pool, script, N, weights);
        assert_int_equal(pool_divide(&pool, 2, of, &error), STATUS_OK);
        const struct pool_settings settings = {.jobs = 1, .share = {.number = number, .of = 2}};
        assert_int_equal(pool_run(&pool, &settings, &error), STATUS_OK);
        int mine = 0;
        for (int i = 0; i < N; i++) {
            assert_true(pool.jobs[i].elsewhere == (of[i] != number));
            assert_true(pool.jobs[i].done == (of[i] == number));
            mine += of[i] == number;
        }
        assert_int_equal(board->count, mine);
        pool_free(&pool);
    }
}

TEST_BETWEEN(begin, NULL);
