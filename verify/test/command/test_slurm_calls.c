/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the engine slurm on the simulated cluster of fake_slurm.h: a controller that does not
 * answer, interrupts, several calls for one study, and the files left behind. */
#define _GNU_SOURCE /* nftw */
#include "test.h"

#include <sys/file.h>

#include "fake_slurm_call.h"

/* ---- commands that fail or hang ---- */

TEST(answers_of_sbatch)
{
    again();
    slurm.answers = ";elsewhere"; /* as sbatch prints if there are several clusters */
    assert_int_equal(compute_all(), STATUS_OK);
    again();
    slurm.no_sbatch = true;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("no command sbatch: No such file or directory (sbatch, squeue and scancel are "
               "needed, on a machine that may submit jobs)");
    again();
    slurm.refuses = "sbatch: error: invalid partition specified: none";
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("--engine slurm: sbatch failed (exit status 1): sbatch: error: invalid partition");
    /* a refused submission does not count as a try */
    slurm.refuses = NULL;
    for (int t = 0; t < 3; t++) slurm.fates[2][t] = t < 2 ? ENDS_BADLY : COMPLETES;
    assert_int_equal(compute_all(), STATUS_OK);
    assert_string_equal(slurm.arrays, "1-3 2 2 ");
}

static void lose_folder(void)
{
    char path[200], other[220];
    snprintf(path, sizeof path, "%s/slurm", call.folder.cache_folder);
    snprintf(other, sizeof other, "%s.lost", path);
    assert_int_equal(rename(path, other), 0);
}

/* The folder of the state disappears while tasks are submitted. If sbatch fails, too, the message
 * is about that. */
TEST(state_that_cannot_be_saved)
{
    for (int refused = 0; refused < 2; refused++) {
        again();
        slurm.submitting = lose_folder;
        slurm.refuses = refused ? "sbatch: error: invalid partition specified: none" : NULL;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        says_error(refused ? "invalid partition" : ".json': No such file or directory");
        assert_int_equal(slurm.submissions, !refused);
    }
}

TEST(controller_that_does_not_answer)
{
    static const struct {
        double from, to;
        enum status status;
    } times[] = {
        {0, 100.1, STATUS_ENVIRONMENT}, /* the controller never answers */
        {101, 102, STATUS_OK},          {101, 200, STATUS_OK},
        {102, 219, STATUS_OK},          {102, 250, STATUS_ENVIRONMENT},
    };
    for (size_t i = 0; i < sizeof times / sizeof *times; i++)
        for (int quiet = 0; quiet < 2; quiet++) {
            again();
            call.options.quiet = quiet;
            slurm.away_from = times[i].from, slurm.away_to = times[i].to;
            assert_int_equal(compute_all(), times[i].status);
            const char *note = strstr(call.said, "; trying again\n");
            assert_int_equal(note != NULL, !quiet);
            if (note) assert_null(strstr(note + 14, "trying again")); /* printed once */
            if (times[i].status) {
                says_error("squeue failed (exit status 1): slurm_load_jobs error: Unable to "
                           "contact slurm controller");
                assert_true(slurm.now < (times[i].from > 0 ? 102 + 140 : 101));
            }
            assert_int_equal(slurm.submissions, times[i].from > 0);
        }
    /* absent once, and not for too long */
    again();
    slurm.fates[2][0] = STAYS;
    slurm.away_from = 101, slurm.away_to = 211;
    slurm.interrupt = 1000;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("interrupted");
}

static void go_away_again(void)
{
    if (slurm.now > 300 && slurm.now < 310) slurm.away_from = 320, slurm.away_to = 430;
}

TEST(controller_absent_twice)
{
    again();
    slurm.fates[2][0] = STAYS;
    slurm.away_from = 101, slurm.away_to = 211;
    slurm.interrupt = 600;
    slurm.meanwhile = go_away_again;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("interrupted");
    assert_true(slurm.away_from > 300);
    const char *first = strstr(call.said, "trying again");
    assert_non_null(first);
    assert_non_null(strstr(first + 1, "trying again"));
}

/* ---- watching and interrupting ---- */

static void results_appear(void)
{
    if (slurm.now > 110) store_share(2, SHARES);
}

/* If the results of a running task are there already, the task is cancelled, if Slurm permits
 * that. */
TEST(superfluous_tasks_are_cancelled)
{
    for (int refused = 0; refused < 2; refused++) {
        char text[100];
        again();
        slurm.fates[2][0] = STAYS;
        slurm.meanwhile = results_appear;
        slurm.refuses_cancel = refused;
        assert_int_equal(compute_all(), STATUS_OK);
        snprintf(text, sizeof text, "--name=%s ", slurm.name);
        assert_string_equal(slurm.cancelled, text);
        all_is_left_behind_in_order();
    }
}

/* A task that Slurm holds, and that may not be cancelled, is waited for. */
TEST(held_tasks_are_waited_for)
{
    again();
    slurm.fates[2][0] = HELD;
    slurm.refuses_cancel = true;
    slurm.interrupt = 120;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    says_error("interrupted; 1 tasks go on");
    assert_string_equal(slurm.arrays, "1-3 ");
}

/* After Ctrl-C without a terminal or without a yes, the tasks continue, and the next call attaches
 * to them. */
TEST(interrupted)
{
    static const struct {
        const char *answer; /* NULL: no terminal */
        bool cancelled;
    } answers[] = {{NULL, false},   {"n\n", false}, {"\n", false},     {"", false},
                   {"yes\n", true}, {"Y\n", true},  {"no, y\n", false}};
    for (size_t i = 0; i < sizeof answers / sizeof *answers; i++)
        for (int refused = 0; refused < 2; refused++) {
            char text[200], path[200];
            again();
            slurm.fates[2][0] = STAYS;
            slurm.fates[3][0] = STAYS;
            slurm.interrupt = 120;
            slurm.refuses_cancel = refused;
            slurm.terminal = answers[i].answer != NULL;
            snprintf(path, sizeof path, "%s/answer", call.folder.cache_folder);
            FILE *file = fopen(path, "w");
            fputs(answers[i].answer ? answers[i].answer : "y\n", file);
            fclose(file);
            assert_non_null(freopen(path, "r", stdin));
            assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
            snprintf(text, sizeof text, "Cancel the 2 tasks of %s? They go on otherwise. [y/N] ",
                     slurm.name);
            assert_int_equal(strstr(call.said, text) != NULL, slurm.terminal);
            snprintf(text, sizeof text, "--name=%s ", slurm.name);
            assert_string_equal(slurm.cancelled, answers[i].cancelled ? text : "");
            if (!answers[i].cancelled) {
                says_error("interrupted; 2 tasks go on: the same command attaches to them again, "
                           "scancel --name=sphproof-");
                assert_int_equal(files("*.json"), 1);
            } else if (refused) {
                says_error("scancel failed (exit status 1): scancel: error: Kill job error");
                assert_int_equal(files("*.json"), 1);
            } else {
                says_error("interrupted; its tasks are cancelled, what is done is kept in");
                assert_int_equal(files("*.json"), 0);
            }
            /* the next call does not submit running tasks a second time, but submits cancelled
             * ones */
            slurm.meanwhile = NULL;
            for (size_t k = 0; k < slurm.count; k++)
                if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = COMPLETES;
            assert_int_equal(compute_all(), STATUS_OK);
            assert_string_equal(slurm.arrays,
                                answers[i].cancelled && !refused ? "1-3 2-3 " : "1-3 ");
            all_is_left_behind_in_order();
        }
}

/* The signal's former handler is installed again afterwards. */
TEST(signal_handler_is_restored)
{
    struct sigaction before, now; /* in a background job of a shell SIGINT is ignored */
    again();
    assert_int_equal(sigaction(SIGINT, NULL, &before), 0);
    assert_int_equal(compute_all(), STATUS_OK);
    assert_int_equal(sigaction(SIGINT, NULL, &now), 0);
    assert_true(now.sa_handler == before.sa_handler);
}

/* A new call finds the tasks of an interrupted one, and counts their tries. */
TEST(submitted_tasks_are_found_again)
{
    for (int i = 0; i < 2 * SHARES; i++) {
        const int share = 1 + i / 2, fate = i % 2;
        char arrays[32];
        again();
        slurm.fates[share][0] = STAYS;
        slurm.interrupt = 120;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        for (size_t k = 0; k < slurm.count; k++)
            if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = ENDS_BADLY;
        slurm.fates[share][1] = ENDS_BADLY;
        slurm.fates[share][2] = fate ? COMPLETES : ENDS_BADLY;
        assert_int_equal(compute_all(), fate ? STATUS_OK : STATUS_ENVIRONMENT);
        snprintf(arrays, sizeof arrays, "1-3 %d %d ", share, share);
        assert_string_equal(slurm.arrays, arrays);
        says("submitted again (1 of 2)"), says("submitted again (2 of 2)");
    }
}

static const char *planted; /* what another process writes into the state file */

static void write_state(void)
{
    char path[300];
    if (!planted || slurm.now < 110) return;
    state_path(path);
    FILE *file = fopen(path, "w");
    fputs(planted, file);
    fclose(file);
    planted = NULL;
}

/* Interrupts a call while a share still runs, and opens its state file to write another one. */
static FILE *open_state(void)
{
    char path[300];
    again();
    slurm.fates[2][0] = STAYS;
    slurm.interrupt = 130;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    state_path(path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    return file;
}

/* The state kept between calls, as another process may have changed it. */
TEST(state_file)
{
    static const struct {
        const char *text;
        enum status status;
        const char *arrays;
    } states[] = {
        {"{\"tasks\": 3, \"tries\": [1, 1, 1], \"jobs\": [7, 7, 7]}", STATUS_OK, "1-3 2 2 "},
        {"{\"tasks\": 3, \"tries\": [1, 2, 1], \"jobs\": [7, 7, 7]}", STATUS_OK, "1-3 2 "},
        {"{\"tasks\": 3, \"tries\": [1, 3, 1], \"jobs\": [7, 7, 7]}", STATUS_ENVIRONMENT, "1-3 "},
        {"{\"tasks\": 2, \"tries\": [1, 1], \"jobs\": [7, 7]}", STATUS_ENVIRONMENT, "1-3 "},
        {"{\"tasks\": 4, \"tries\": [1, 1, 1, 1], \"jobs\": [7, 7, 7, 7]}", STATUS_ENVIRONMENT,
         "1-3 "},
    };
    for (size_t i = 0; i < sizeof states / sizeof *states; i++) {
        again();
        slurm.fates[2][0] = STAYS;
        slurm.fates[2][1] = i ? COMPLETES : ENDS_BADLY;
        slurm.interrupt = 130;
        slurm.meanwhile = write_state;
        planted = states[i].text;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        if (i > 2) {
            says_error("another call has divided this study anew: call again to attach to it");
            continue;
        }
        for (size_t k = 0; k < slurm.count; k++)
            if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = ENDS_BADLY;
        slurm.meanwhile = NULL;
        assert_int_equal(compute_all(), states[i].status);
        assert_string_equal(slurm.arrays, states[i].arrays);
    }
    /* the least and the greatest number of shares, and one too many */
    for (int tasks = 1; tasks <= SLURM_TASKS_MAX + 1; tasks += tasks > 1 ? 1 : 999) {
        char of[32];
        FILE *file = open_state();
        fprintf(file, "{\"tasks\": %d", tasks);
        for (int k = 0; k < 2; k++) {
            fputs(k ? ", \"jobs\": [0" : ", \"tries\": [0", file);
            for (int t = 1; t < tasks; t++) fputs(", 0", file);
            fputc(']', file);
        }
        fputc('}', file);
        fclose(file);
        for (size_t k = 0; k < slurm.count; k++) slurm.tasks[k].fate = FORGOTTEN;
        assert_int_equal(compute_all(), STATUS_OK);
        snprintf(of, sizeof of, "TASK_ID/%d ", tasks > SLURM_TASKS_MAX ? SHARES : tasks);
        assert_non_null(strstr(slurm.wrap, of));
    }
    /* invalid states: the study is divided again */
    static const char *const none[] = {"",
                                       "{",
                                       "[]",
                                       "{}",
                                       "{\"tasks\": 0, \"tries\": [], \"jobs\": []}",
                                       "{\"tasks\": 2, \"tries\": [1], \"jobs\": [7, 7]}",
                                       "{\"tasks\": 2, \"tries\": [1, 1], \"jobs\": [7]}",
                                       "{\"tasks\": \"2\", \"tries\": [1, 1], \"jobs\": [7, 7]}"};
    for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
        FILE *file = open_state();
        fputs(none[i], file);
        fclose(file);
        for (size_t k = 0; k < slurm.count; k++) slurm.tasks[k].fate = FORGOTTEN;
        call.work.tasks = 2;
        assert_int_equal(compute_all(), STATUS_OK);
        assert_non_null(strstr(slurm.wrap, "TASK_ID/2 "));
    }
}

/* The number of shares is kept, whatever the next call asks for. */
TEST(number_of_shares_is_kept)
{
    again();
    slurm.fates[2][0] = STAYS;
    slurm.interrupt = 120;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    for (size_t k = 0; k < slurm.count; k++)
        if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = ENDS_BADLY;
    call.work.tasks = 2;
    assert_int_equal(compute_all(), STATUS_OK);
    assert_string_equal(slurm.arrays, "1-3 2 ");
    assert_non_null(strstr(slurm.wrap, "TASK_ID/3 "));
}

/* If a share is given up, the message has the last nonempty line of its log, and the log is
 * kept. */
TEST(last_line_of_the_log)
{
    static const struct {
        const char *text, *line;
    } logs[] = {{"one\ntwo\n", "two\n"},
                {"one\n  \n\n", "one\n"},
                {"", "(empty)\n"},
                {"one", "one\n"},
                {"a\x1b[31mb\n", "a"}};
    for (size_t i = 0; i < sizeof logs / sizeof *logs; i++) {
        char path[400], text[200];
        again();
        slurm.fates[2][0] = STAYS;
        slurm.interrupt = 120;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        snprintf(path, sizeof path, "%s/slurm/%s-7_2.log", call.folder.cache_folder, slurm.name);
        FILE *file = fopen(path, "w");
        fputs(logs[i].text, file);
        fclose(file);
        for (size_t k = 0; k < slurm.count; k++)
            if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = CANCELLED_RUNNING;
        assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
        snprintf(text, sizeof text, "-7_2.log: %s", logs[i].line);
        says(text);
        assert_null(strchr(call.said, '\x1b'));
        assert_int_equal(files("*.log"), 1);
        unlink(path);
    }
}

/* Logs of completed shares are removed. */
TEST(logs_of_completed_shares_are_removed)
{
    again();
    slurm.fates[2][0] = STAYS;
    slurm.interrupt = 120;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    for (int s = 1; s <= SHARES; s++) {
        char path[400];
        snprintf(path, sizeof path, "%s/slurm/%s-7_%d.log", call.folder.cache_folder, slurm.name,
                 s);
        FILE *file = fopen(path, "w");
        fclose(file);
    }
    for (size_t k = 0; k < slurm.count; k++)
        if (slurm.tasks[k].fate == STAYS) slurm.tasks[k].fate = COMPLETES;
    assert_int_equal(compute_all(), STATUS_OK);
    all_is_left_behind_in_order();
}

/* Progress: tasks in the queue, results in the cache, and these as a share of the work. A task of
 * an older array, which had more shares, does not count. */
TEST(reported_progress)
{
    int shares[N];
    char text[100];
    double left = 0, whole = 0;
    again();
    call.reports = true;
    slurm.fates[2][0] = STAYS, slurm.fates[3][0] = HELD;
    slurm.tasks[slurm.count++] = (struct fake_task){.job = 6, .index = 1000000, .fate = STAYS};
    slurm.refuses_cancel = true;
    slurm.interrupt = 120;
    assert_int_equal(pool_divide(&call.pool, SHARES, shares, &call.error), STATUS_OK);
    for (int i = 0; i < N; i++) {
        whole += call.pool.jobs[i].weight;
        left += shares[i] > 1 ? call.pool.jobs[i].weight : 0;
    }
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    snprintf(text, sizeof text, "converge, slurm: 1 run, 1 wait: %zu of %d (%.0f %%), 10 s",
             shares_computations(1), N, 100 * (1 - left / whole));
    says(text);
}

static void is_locked(void)
{
    char path[200];
    snprintf(path, sizeof path, "%s/slurm", call.folder.cache_folder);
    const int folder = open(path, O_RDONLY);
    assert_true(folder >= 0);
    assert_int_equal(flock(folder, LOCK_EX | LOCK_NB), -1);
    close(folder);
}

/* No other call acts on the study between a look into the queue and the submission after it. */
TEST(one_call_acts_at_a_time)
{
    again();
    slurm.meanwhile = slurm.submitting = is_locked;
    assert_int_equal(compute_all(), STATUS_OK);
    assert_int_equal(slurm.submissions, 1);
}

/* The engine polls ever less often, from every half second to every quarter of a minute. */
TEST(polling_intervals)
{
    again();
    slurm.fates[2][0] = STAYS;
    slurm.interrupt = 1100;
    assert_int_equal(compute_all(), STATUS_ENVIRONMENT);
    size_t looks = 0; /* the interval is a twentieth of the time passed */
    for (double passed = 0; passed < 1000; looks++)
        passed += passed < 10.1 ? 0.505 : passed < 300 ? passed / 20 : 15;
    assert_int_equal(slurm.questions, looks);
}

TEST_BETWEEN(begin, end);
