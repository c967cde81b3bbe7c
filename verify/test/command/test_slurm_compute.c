/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests what the engine slurm submits and how it handles tasks that end badly, on the simulated
 * cluster of fake_slurm.h. (test_slurm_calls.c: interrupts and repeated calls.) */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#include "fake_slurm_call.h"

/* ---- fates of tasks ---- */

static const struct {
    enum fate fate;
    const char *state; /* as messages name it; NULL: nothing is submitted again */
    bool given_up;     /* the share is given up at once */
} rows[] = {
    {COMPLETES, NULL, false},
    {LATE, NULL, false},
    {REQUEUED, NULL, false},
    {SUSPENDED, NULL, false},
    {USELESS, "COMPLETED", false},
    {ENDS_BADLY, "FAILED", false},
    {TIMES_OUT, "TIMEOUT", false},
    {LOSES_NODE, "NODE_FAIL", false},
    {PREEMPTED, "PREEMPTED", false},
    {NO_MEMORY, "OUT_OF_MEMORY", false},
    {NO_BOOT, "BOOT_FAIL", false},
    {MISSES_DEADLINE, "DEADLINE", false},
    {REVOKED, "REVOKED", false},
    {FORGOTTEN, "RUNNING", false},
    {CANCELLED_RUNNING, "CANCELLED", true},
    {CANCELLED_WAITING, "CANCELLED", true},
    {CANCELLED_AT_ONCE, "CANCELLED", true},
    /* such a task may have been cancelled with its array: the engine cannot know */
    {HELD, "PENDING", false},
    {NEVER_SEEN, "not in the queue", false},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* A share that ends badly once is submitted again, and no other share is. */
TEST(share_that_fails_once)
{
    for (int i = 0; i < SHARES * ROWS; i++) {
        const int r = i % ROWS, share = 1 + i / ROWS;
        char note[200], cancelled[16], arrays[16];
        again();
        slurm.fates[share][0] = rows[r].fate;
        const enum status status = compute_all();
        if (rows[r].given_up) {
            assert_int_equal(status, STATUS_ENVIRONMENT);
            assert_string_equal(slurm.arrays, "1-3 ");
            continue;
        }
        assert_int_equal(status, STATUS_OK);
        all_is_left_behind_in_order();
        snprintf(cancelled, sizeof cancelled, "7_%d ", share);
        snprintf(arrays, sizeof arrays, "1-3 %d ", share);
        assert_string_equal(slurm.cancelled, rows[r].fate == HELD ? cancelled : "");
        assert_string_equal(slurm.arrays, rows[r].state ? arrays : "1-3 ");
        if (!rows[r].state) {
            assert_string_equal(call.said, "");
            continue;
        }
        snprintf(note, sizeof note,
                 "sphproof: note: share %d ended (%s) and %zu of its computations are missing: "
                 "submitted again (1 of 2)\n",
                 share, rows[r].state, shares_computations(share));
        assert_string_equal(call.said, note);
    }
}

/* A share that ends badly three times is given up, and the others continue. The message names what
 * is missing, and where its logs are. */
TEST(share_that_fails_three_times)
{
    for (int r = 0; r < ROWS; r++) {
        if (!rows[r].state) continue;
        char text[400], what[200], name[64] = "";
        again();
        for (int t = 0; t < 3; t++) slurm.fates[2][t] = rows[r].fate;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        assert_string_equal(slurm.arrays, rows[r].given_up ? "1-3 " : "1-3 2 2 ");
        assert_int_equal(lacking(), shares_computations(2));
        snprintf(what, sizeof what,
                 "--engine slurm: %zu computations are missing; what is done is kept in",
                 shares_computations(2));
        says_error(what);
        says_error(call.folder.cache_folder);
        snprintf(what, sizeof what, "share 2 of 3 (%s, submitted %d times), log ",
                 rows[r].fate == HELD ? "CANCELLED" : rows[r].state, rows[r].given_up ? 1 : 3);
        says(what);
        snprintf(what, sizeof what, "-%d_2.log: (there is none)\n", rows[r].given_up ? 7 : 9);
        says(what);
        assert_null(strstr(call.said, "share 1 of"));
        assert_null(strstr(call.said, "share 3 of"));
        size_t missing = 0;
        for (int i = 0; i < N; i++) {
            snprintf(name, sizeof name, "missing: task %d (share 2)\n", i);
            missing += strstr(call.said, name) != NULL;
            snprintf(text, sizeof text, "task %d", i);
            assert_int_equal(strstr(call.said, name) != NULL, !cache_has(&call.folder.cache, text));
        }
        assert_int_equal(missing, shares_computations(2));
        if (!rows[r].given_up) says("submitted again (1 of 2)"), says("submitted again (2 of 2)");
        assert_int_equal(files("*.json"), 0);
        /* a new call starts from the beginning, even while the queue still shows what was cancelled
         */
        slurm.arrays[0] = '\0';
        slurm.tries[2] = 3;
        assert_int_equal(compute_all(), STATUS_OK);
        assert_int_equal(slurm.submissions, rows[r].given_up ? 2 : 4);
        assert_int_equal(lacking(), 0);
    }
}

/* The message names the first ten of many missing computations and of many shares. */
TEST(many_are_missing)
{
    for (int shares = SHARES; shares <= 11; shares += 8) {
        again();
        call.work.tasks = shares;
        for (int i = 0; i < N; i++) call.pool.jobs[i].weight = 1;
        for (int s = 1; s <= shares; s++)
            for (int t = 0; t < 3; t++) slurm.fates[s][t] = ENDS_BADLY;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        for (int i = 0; i < N; i++) {
            char name[64];
            snprintf(name, sizeof name, "sphproof: missing: task %d (share ", i);
            assert_int_equal(strstr(call.said, name) != NULL, i < 10);
        }
        for (int s = 1; s <= shares; s++) {
            char share[48];
            snprintf(share, sizeof share, "share %d of %d (FAILED, ", s, shares);
            assert_int_equal(strstr(call.said, share) != NULL, s <= 10);
        }
    }
}

/* Messages about a share describe its last task. */
TEST(messages_describe_the_last_task)
{
    again();
    slurm.fates[2][0] = ENDS_BADLY, slurm.fates[2][1] = NEVER_SEEN, slurm.fates[2][2] = TIMES_OUT;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says("share 2 ended (FAILED)");
    says("share 2 ended (not in the queue)");
    says("share 2 of 3 (TIMEOUT, submitted 3 times)");
}

/* The record of an array's cancelled tasks says nothing of those of another array. */
TEST(cancelled_tasks_of_another_array)
{
    again();
    slurm.fates[2][0] = CANCELLED_WAITING;
    slurm.fates[1][0] = ENDS_BADLY, slurm.fates[1][1] = NEVER_SEEN;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    assert_string_equal(slurm.arrays, "1-3 1 1 ");
    assert_int_equal(lacking(), shares_computations(2));
}

static void submit_share_2(void)
{
    if (slurm.tries[2] == 1) add_tasks("2", 90);
}

/* Two tasks compute one share: the one that is still alive counts, in whichever order they are
 * listed. */
TEST(two_tasks_of_a_share)
{
    for (int backwards = 0; backwards < 2; backwards++)
        for (int older = 0; older < 2; older++) {
            again();
            slurm.backwards = backwards;
            slurm.fates[2][0] = older ? STAYS : ENDS_BADLY;
            slurm.fates[2][1] = older ? ENDS_BADLY : STAYS;
            slurm.interrupt = 110;
            slurm.meanwhile = older ? submit_share_2 : NULL;
            assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
            says_error("interrupted; 1 tasks go on");
            assert_string_equal(slurm.arrays, older ? "1-3 " : "1-3 2 ");
            assert_int_equal(slurm.tries[2], 2);
        }
}

/* The engine waits 30 s for the results of each task that ended well, because files from other
 * machines may become visible later. */
TEST(late_results_are_waited_for)
{
    again();
    slurm.fates[2][0] = slurm.fates[2][1] = USELESS;
    assert_int_equal(compute_all(), STATUS_OK);
    for (int k = 3; k < 5; k++) {
        const double ended = slurm.tasks[k - 1].submitted + 3;
        assert_true(slurm.tasks[k].submitted >= ended + 30 &&
                    slurm.tasks[k].submitted < ended + 40);
    }
    again();
    slurm.fates[2][0] = ENDS_BADLY;
    assert_int_equal(compute_all(), STATUS_OK);
    assert_true(slurm.tasks[3].submitted >= 103 && slurm.tasks[3].submitted < 104);
}

/* ---- what is submitted ---- */

TEST(only_what_is_missing)
{
    static const struct {
        int there; /* the share that is in the cache */
        const char *array;
    } there[] = {{0, "1-3 "}, {1, "2-3 "}, {2, "1,3 "}, {3, "1-2 "}};
    for (size_t i = 0; i < 4; i++) {
        again();
        if (there[i].there) store_share(there[i].there, SHARES);
        assert_int_equal(compute_all(), STATUS_OK);
        assert_string_equal(slurm.arrays, there[i].array);
    }
    again();
    for (int s = 1; s <= SHARES; s++) store_share(s, SHARES);
    slurm.no_sbatch = true, slurm.away_to = 1e9; /* sbatch is not called */
    assert_int_equal(compute_all(), STATUS_OK);
    assert_int_equal(slurm.questions, 0);
}

/* Each task has ten minutes of work, and there are no more tasks than computations. */
TEST(number_of_shares)
{
    static const struct {
        double weight; /* of each of the first 8 computations; the others have none */
        int jobs, tasks, shares;
        const char *array;
    } cases[] = {{0, 1, 0, 1, "1 "},     {10, 1, 0, 1, "1 "},    {150, 1, 0, 2, "1-2 "},
                 {149, 1, 0, 1, "1 "},   {150, 2, 0, 1, "1 "},   {300, 2, 0, 2, "1-2 "},
                 {300, 1, 0, 4, "1-4 "}, {10, 1, 4, 4, "1-4 "},  {1e9, 1, 1, 1, "1 "},
                 {224, 1, 0, 2, "1-2 "}, {225, 1, 0, 3, "1-3 "}, {1e9, 1, 0, N, "1-9 "}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char of[40];
        again();
        for (int k = 0; k < N; k++) call.pool.jobs[k].weight = k < 8 ? cases[i].weight : 0;
        call.work.jobs = cases[i].jobs;
        call.work.tasks = cases[i].tasks;
        assert_int_equal(compute_all(), STATUS_OK);
        snprintf(of, sizeof of, "TASK_ID/%d --only-build", cases[i].shares);
        assert_non_null(strstr(slurm.wrap, of));
        assert_string_equal(slurm.arrays, cases[i].array);
    }
}

/* A share has this command line: without the options that only the caller needs, and quoted so that
 * a shell reads the same words. */
TEST(command_line_of_a_share)
{
    char program[1000], quoted[2000] = "", text[4000];
    again();
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    assert_true(length > 0);
    program[length] = '\0';
    for (const char *c = program; *c; c++) /* the folder's name may have quotes */
        snprintf(quoted + strlen(quoted), sizeof quoted - strlen(quoted),
                 *c == '\'' ? "'\\'%c" : "%c", *c);
    set("n", "1,2,3"), set("words", "it's \"$HOME\" `x`\n2"), set("flag", "");
    set("jobs", "2"), set("plot", "p.svg"), set("cache", "a b"), set("engine", "slurm");
    set("engine-tasks", "3"), set("list", ""), set("failures", ""), set("history", "h"),
        set("junit", "j"), set("resume", "");
    call.arguments[1] = (char *)"-1'";
    call.options.count = 2;
    call.options.threads = 3;
    call.work.jobs = 2;
    set("engine-options", "--partition=main  --time=1:00\t--mem=1G");
    assert_int_equal(compute_all(), STATUS_OK);
    snprintf(text, sizeof text,
             "exec '%s' converge --shard $SLURM_ARRAY_TASK_ID/3 --only-build %s --threads 3 --jobs "
             "2 --n='1,2,3' --words='it'\\''s \"$HOME\" `x`\n2' --flag --cache='a b' -- 'sod' "
             "'-1'\\'''",
             quoted, call.folder.cache.build);
    assert_string_equal(slurm.wrap, text);
    static const char *const words[] = {
        "--requeue",   "--open-mode=append", "--cpus-per-task=6", "--partition=main",
        "--time=1:00", "--mem=1G",           "--parsable"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        assert_string_equal(slurm.words[i], words[i]);
    snprintf(text, sizeof text, "/slurm/%s-%%A_%%a.log", slurm.name);
    assert_non_null(strstr(slurm.output, text));
    assert_true(slurm.output[0] == '/'); /* an absolute path, because tasks may start elsewhere */
}

/* A command without the option --jobs does not get it. */
TEST(a_command_without_jobs)
{
    static const struct command bench = {.name = "bench", .options = list + 1};
    char text[100];
    again();
    call.options.command = &bench;
    call.options.values = call.values + 1;
    set("n", "7");
    assert_int_equal(compute_all(), STATUS_OK);
    snprintf(text, sizeof text,
             "' bench --shard $SLURM_ARRAY_TASK_ID/3 --only-build %s --threads "
             "1 --n='7' -- 'sod'",
             call.folder.cache.build);
    assert_non_null(strstr(slurm.wrap, text));
}

TEST(command_line_too_long)
{
    char words[400] = "";
    again();
    for (int i = 0; i < 54; i++) strcat(words, "-x ");
    set("engine-options", words);
    assert_int_equal(compute_all(), STATUS_OK);
    again();
    strcat(words, "-x");
    set("engine-options", words);
    assert_int_equal(compute_all(), STATUS_BAD_INPUT);
    says_error("--engine-options: more than 54 words");
    assert_int_equal(slurm.submissions, 0);
}

/* The same study in the same folder has the same name; another study or folder has another name. */
TEST(name_of_a_study)
{
    char name[64];
    again();
    assert_int_equal(compute_all(), STATUS_OK);
    assert_true(begins(slurm.name, "sphproof-") && strlen(slurm.name) == 9 + 16);
    snprintf(name, sizeof name, "%s", slurm.name);
    call.pool.jobs[3].key[0] = 'T';
    assert_int_equal(compute_all(), STATUS_OK);
    assert_string_not_equal(slurm.name, name);
    call.pool.jobs[3].key[0] = 't';
    char path[CACHE_PATH_MAX];
    cache_path(&call.folder.cache, "task 1", path);
    assert_int_equal(unlink(path), 0);
    snprintf(call.folder.cache.folder, sizeof call.folder.cache.folder, "./%s",
             call.folder.cache_folder);
    assert_int_equal(compute_all(), STATUS_OK);
    assert_string_equal(slurm.name, name);
    again();
    assert_int_equal(compute_all(), STATUS_OK);
    assert_string_not_equal(slurm.name, name);
    again();
    strcat(call.folder.cache.folder, "_none");
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("_none: No such file or directory");
    assert_int_equal(slurm.submissions, 0);
}

TEST_BETWEEN(begin, end);
