/* SPDX-License-Identifier: GPL-3.0-or-later
 * Simulates Slurm inside this process for tests of the engine: sbatch, squeue and scancel give the
 * answers of Slurm 22.05 (recorded on a cluster of two nodes), time passes only while the process
 * sleeps, and a test sets the fate of each task. Needs the linker's --wrap of child_run,
 * clock_wall, isatty and nanosleep. Include after test.h. */
#pragma once

#include <signal.h>
#include <stdbool.h>
#include <time.h>
#include <unistd.h>

#include "cache.h"
#include "child.h"
#include "pool.h"

enum { FAKE_TASKS = 40, FAKE_TRIES = 4, FAKE_SHARES = 14 };

/* What happens to a task. */
enum fate {
    COMPLETES, /* its results are in the cache */
    LATE,      /* likewise, but the folder shows them 12 s later */
    USELESS,   /* it ends well without results */
    ENDS_BADLY,
    TIMES_OUT,
    LOSES_NODE,
    PREEMPTED,
    NO_MEMORY,
    NO_BOOT,
    MISSES_DEADLINE,
    REVOKED,
    CANCELLED_RUNNING,
    CANCELLED_WAITING, /* the array's record has N/A in place of its task number */
    CANCELLED_AT_ONCE, /* likewise, before the first squeue */
    FORGOTTEN,         /* the controller no longer knows it */
    NEVER_SEEN,        /* the controller has never known it */
    REQUEUED,          /* pending again for some seconds, then COMPLETES */
    SUSPENDED,         /* for some seconds, then COMPLETES */
    HELD,              /* Slurm cannot start it, and holds it for ever */
    STAYS,             /* it runs for ever */
    FATES
};

struct fake_task {
    long job;
    int index;
    enum fate fate;
    double submitted;
    bool stored, cancelled;
};

static struct fake_slurm {
    double now;
    const struct pool *pool;
    const struct cache *cache;
    enum fate fates[FAKE_SHARES + 1][FAKE_TRIES]; /* by share, and by submission */
    int tries[FAKE_SHARES + 1];
    struct fake_task tasks[FAKE_TASKS];
    size_t count, submissions, questions;
    char arrays[200];    /* the argument of --array of each submission, with a space after it */
    char cancelled[200]; /* the arguments of scancel, likewise */
    char name[64], output[CACHE_PATH_MAX], wrap[4000], words[80][100]; /* of the last sbatch */
    double away_from, away_to; /* the controller does not answer between these times */
    bool backwards;            /* squeue lists the newest tasks first */
    bool no_sbatch;            /* the program does not exist */
    bool refuses_cancel;
    const char *refuses; /* the error message of sbatch in place of a number */
    const char *answers; /* what sbatch prints after the number */
    double interrupt;    /* time of Ctrl-C; 0: never */
    bool terminal;
    void (*meanwhile)(void);  /* called at every squeue */
    void (*submitting)(void); /* called at every sbatch */
} slurm;

double __wrap_clock_wall(void);
double __wrap_clock_wall(void)
{
    return slurm.now;
}

int __wrap_nanosleep(const struct timespec *time, struct timespec *left);
int __wrap_nanosleep(const struct timespec *time, struct timespec *left)
{
    (void)left;
    const double before = slurm.now;
    slurm.now += (double)time->tv_sec + 1e-9 * (double)time->tv_nsec;
    assert_true(time->tv_sec >= 0 && time->tv_nsec >= 0 && time->tv_nsec < 1000000000);
    assert_true(slurm.now > before && slurm.now < 5000); /* polls end, and are rare */
    if (slurm.interrupt > 0 && slurm.now >= slurm.interrupt) {
        slurm.interrupt = 0;
        raise(SIGINT);
    }
    return 0;
}

int __wrap_isatty(int file);
int __wrap_isatty(int file)
{
    return file == STDIN_FILENO && slurm.terminal;
}

static inline bool begins(const char *word, const char *with)
{
    return strncmp(word, with, strlen(with)) == 0;
}

static inline enum status answer(struct child_said *said, int code, const char *output,
                                 const char *complaint)
{
    *said = (struct child_said){.exit = code, .output = strdup(output)};
    snprintf(said->complaint, sizeof said->complaint, "%s", complaint);
    return STATUS_OK;
}

/* Stores the results of the share's computations. */
static inline void store_share(int share, int of)
{
    int *shares = calloc(slurm.pool->count + 1, sizeof *shares);
    struct error error = {0};
    assert_int_equal(pool_divide(slurm.pool, of, shares, &error), STATUS_OK);
    for (size_t i = 0; i < slurm.pool->count; i++) {
        json_t *reply = json_pack("{s:i, s:s, s:{s:i}}", "status", 0, "message", "", "document",
                                  "number", (int)i);
        if (shares[i] == share)
            assert_int_equal(cache_store(slurm.cache, slurm.pool->jobs[i].key, reply, &error),
                             STATUS_OK);
        json_decref(reply);
    }
    free(shares);
}

/* A task is pending for a second, runs for two, and then ends as planned. */
static inline void task_state(const struct fake_task *task, const char **state, const char **reason)
{
    static const struct {
        const char *state, *reason;
    } ends[FATES] = {
        [COMPLETES] = {"COMPLETED", "None"},
        [LATE] = {"COMPLETED", "None"},
        [USELESS] = {"COMPLETED", "None"},
        [ENDS_BADLY] = {"FAILED", "NonZeroExitCode"},
        [TIMES_OUT] = {"TIMEOUT", "TimeLimit"},
        [LOSES_NODE] = {"NODE_FAIL", "NodeDown"},
        [PREEMPTED] = {"PREEMPTED", "None"},
        [NO_MEMORY] = {"OUT_OF_MEMORY", "OutOfMemory"},
        [NO_BOOT] = {"BOOT_FAIL", "NodeDown"},
        [MISSES_DEADLINE] = {"DEADLINE", "DeadLine"},
        [REVOKED] = {"REVOKED", "None"},
        [CANCELLED_RUNNING] = {"CANCELLED", "None"},
        [CANCELLED_WAITING] = {"CANCELLED", "Resources"},
        [CANCELLED_AT_ONCE] = {"CANCELLED", "Resources"},
        [FORGOTTEN] = {NULL, NULL},
        [NEVER_SEEN] = {NULL, NULL},
        [REQUEUED] = {"COMPLETED", "None"},
        [SUSPENDED] = {"COMPLETED", "None"},
        [HELD] = {"PENDING", "launch failed requeued held"},
        [STAYS] = {"RUNNING", "None"},
    };
    const bool at_once =
        task->fate == HELD || task->fate == CANCELLED_AT_ONCE || task->fate == NEVER_SEEN;
    const double age = at_once ? (double)INFINITY : slurm.now - task->submitted;
    *state = ends[task->fate].state, *reason = ends[task->fate].reason;
    if (task->cancelled) {
        *state = "CANCELLED", *reason = "None";
    } else if (age < 1) {
        *state = "PENDING", *reason = "None";
    } else if (age < 3) {
        *state = task->fate == CANCELLED_WAITING ? "PENDING" : "RUNNING", *reason = "None";
    } else if (age < 6 && task->fate == REQUEUED) {
        *state = "PENDING", *reason = "BeginTime";
    } else if (age < 6 && task->fate == SUSPENDED) {
        *state = "SUSPENDED", *reason = "None";
    }
}

static inline void pass_time(int of)
{
    for (size_t i = 0; i < slurm.count; i++) {
        struct fake_task *task = &slurm.tasks[i];
        const char *state, *reason;
        task_state(task, &state, &reason);
        if (task->stored || !state || strcmp(state, "COMPLETED") || task->fate == USELESS) continue;
        if (task->fate == LATE && slurm.now < task->submitted + 15) continue;
        store_share(task->index, of);
        task->stored = true;
    }
}

static int share_count; /* number of shares in the last command line */

static inline enum status fake_squeue(const char *const *words, struct child_said *said)
{
    static const char *const recorded[] = {"squeue", "--noheader", "--array", "--states=all"};
    char text[4000] = "";
    size_t length = 0;
    for (size_t i = 0; i < 4; i++) assert_string_equal(words[i], recorded[i]);
    assert_true(begins(words[4], "--name="));
    assert_string_equal(words[5], "--format=%F %K %T %r");
    assert_null(words[6]);
    slurm.questions++;
    if (slurm.now >= slurm.away_from && slurm.now < slurm.away_to)
        return answer(said, 1, "",
                      "slurm_load_jobs error: Unable to contact slurm controller (connect "
                      "failure)");
    pass_time(share_count);
    long nameless = 0; /* the array whose cancelled pending tasks are listed, in one record */
    for (size_t i = 0; i < slurm.count; i++) {
        const struct fake_task *task = &slurm.tasks[slurm.backwards ? slurm.count - 1 - i : i];
        const char *state, *reason;
        char index[16] = "N/A";
        task_state(task, &state, &reason);
        if (!state || strcmp(words[4] + 7, slurm.name)) continue;
        if (strcmp(reason, "Resources"))
            snprintf(index, sizeof index, "%d", task->index);
        else if (nameless == task->job)
            continue;
        else
            nameless = task->job;
        length += (size_t)snprintf(text + length, sizeof text - length, "%ld %s %s %s\n", task->job,
                                   index, state, reason);
    }
    if (slurm.meanwhile) slurm.meanwhile();
    return answer(said, 0, text, "");
}

/* Adds the tasks of an array in sbatch's notation: 1,3-5. */
static inline void add_tasks(const char *text, long job)
{
    while (*text) {
        int first, last, length = 0;
        assert_int_equal(sscanf(text, "%d%n", &first, &length), 1);
        text += length;
        last = first;
        if (*text == '-') {
            assert_int_equal(sscanf(text, "-%d%n", &last, &length), 1);
            text += length;
            assert_true(last > first);
        }
        for (int k = first; k <= last; k++) {
            assert_true(k >= 1 && k <= FAKE_SHARES && slurm.tries[k] < FAKE_TRIES);
            assert_true(slurm.count < FAKE_TASKS);
            slurm.tasks[slurm.count++] = (struct fake_task){
                .job = job,
                .index = k,
                .fate = slurm.fates[k][slurm.tries[k]++],
                .submitted = slurm.now,
            };
        }
        if (*text) assert_int_equal(*text++, ',');
    }
}

static inline enum status fake_sbatch(const char *const *words, struct child_said *said,
                                      struct error *error)
{
    const char *array = NULL, *wrap = NULL;
    bool parsable = false;
    char text[80];
    if (slurm.submitting) slurm.submitting();
    if (slurm.no_sbatch)
        return error_set(error, STATUS_ENVIRONMENT, "sbatch: No such file or directory");
    if (slurm.refuses) return answer(said, 1, "", slurm.refuses);
    for (size_t i = 1; words[i]; i++) {
        assert_true(i < 80);
        snprintf(slurm.words[i - 1], sizeof slurm.words[0], "%s", words[i]);
        if (begins(words[i], "--array=")) array = words[i] + 8;
        if (begins(words[i], "--job-name="))
            snprintf(slurm.name, sizeof slurm.name, "%s", words[i] + 11);
        if (begins(words[i], "--output="))
            snprintf(slurm.output, sizeof slurm.output, "%s", words[i] + 9);
        if (strcmp(words[i], "--parsable") == 0) parsable = true;
        if (strcmp(words[i], "--wrap") == 0) wrap = words[++i];
    }
    assert_true(array && wrap && parsable && begins(wrap, "exec '"));
    snprintf(slurm.wrap, sizeof slurm.wrap, "%s", wrap);
    const char *of = strstr(wrap, "--shard $SLURM_ARRAY_TASK_ID/");
    assert_true(of && sscanf(of, "--shard $SLURM_ARRAY_TASK_ID/%d", &share_count) == 1);
    const size_t length = strlen(slurm.arrays);
    snprintf(slurm.arrays + length, sizeof slurm.arrays - length, "%s ", array);
    add_tasks(array, 7 + (long)slurm.submissions);
    snprintf(text, sizeof text, "%ld%s\n", 7 + (long)slurm.submissions++,
             slurm.answers ? slurm.answers : "");
    return answer(said, 0, text, "");
}

static inline enum status fake_scancel(const char *const *words, struct child_said *said)
{
    const size_t length = strlen(slurm.cancelled);
    long job = 0;
    int index = 0;
    assert_true(words[1] && !words[2]);
    snprintf(slurm.cancelled + length, sizeof slurm.cancelled - length, "%s ", words[1]);
    if (slurm.refuses_cancel)
        return answer(said, 1, "",
                      "scancel: error: Kill job error on job id 7: Access/permission denied");
    const bool all = begins(words[1], "--name=") && strcmp(words[1] + 7, slurm.name) == 0;
    if (!all) assert_int_equal(sscanf(words[1], "%ld_%d", &job, &index), 2);
    for (size_t i = 0; i < slurm.count; i++)
        if (all || (slurm.tasks[i].job == job && slurm.tasks[i].index == index))
            slurm.tasks[i].cancelled = true;
    return answer(said, 0, "", "");
}

enum status __wrap_child_run(const char *const *words, struct child_said *said,
                             struct error *error);
enum status __wrap_child_run(const char *const *words, struct child_said *said, struct error *error)
{
    if (strcmp(words[0], "squeue") == 0) return fake_squeue(words, said);
    if (strcmp(words[0], "sbatch") == 0) return fake_sbatch(words, said, error);
    assert_string_equal(words[0], "scancel");
    return fake_scancel(words, said);
}
