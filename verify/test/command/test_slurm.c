/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the parsing of Slurm's answers, recorded from Slurm 22.05 (two nodes on one host). Scripts
 * in a folder of their own stand for sbatch, squeue and scancel. (test_slurm_calls.c tests what the
 * engine does with answers, and without.) */
#include "test.h"

#include <sys/stat.h>

#include "own_folder.h"
#include "slurm.h"

/* Makes a command that prints `output` and `complaint`, exits with the code and saves its
 * arguments. */
static void command_says(const char *name, const char *output, const char *complaint, int code)
{
    char text[64];
    snprintf(text, sizeof text, "%s.said", name);
    FILE *file = fopen(path_of(text), "w");
    fputs(output, file);
    fclose(file);
    file = fopen(path_of(name), "w");
    fprintf(file,
            "#!/bin/sh\nprintf '[%%s]' \"$@\" >%s/%s.arguments\nIFS= read -r nothing && exit 99\n"
            "while IFS= read -r line; do echo \"$line\"; done <%s/%s.said\n"
            "[ -z \"%s\" ] || echo \"%s\" >&2\nexit %d\n",
            own_folder, name, own_folder, name, complaint, complaint, code);
    fclose(file);
    assert_int_equal(chmod(path_of(name), 0700), 0);
    assert_int_equal(setenv("PATH", own_folder, 1), 0); /* no other command is found */
}

static const char *arguments_of(const char *name)
{
    static char text[2000];
    char path[64];
    snprintf(path, sizeof path, "%s.arguments", name);
    FILE *file = fopen(path_of(path), "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    return text;
}

/* ---- the queue ---- */

struct expected {
    long job;
    int index;
    bool live;
    const char *state, *reason;
};

static void queue_is(const char *output, const struct expected *tasks, size_t n)
{
    struct slurm_task *found;
    struct error error;
    size_t count;
    command_says("squeue", output, "", 0);
    assert_int_equal(slurm_queue("name", &found, &count, &error), STATUS_OK);
    assert_string_equal(arguments_of("squeue"), "[--noheader][--array][--states=all][--name=name]"
                                                "[--format=%F %K %T %r]");
    assert_int_equal(count, n);
    for (size_t i = 0; i < n; i++) {
        assert_int_equal(found[i].job, tasks[i].job);
        assert_int_equal(found[i].index, tasks[i].index);
        assert_int_equal(found[i].live, tasks[i].live);
        assert_string_equal(found[i].state, tasks[i].state);
        assert_string_equal(found[i].reason, tasks[i].reason);
    }
    free(found);
}

/* Lines of squeue about a task, one for each state. */
TEST(recorded_output_of_squeue)
{
    static const struct {
        const char *line;
        struct expected task;
    } rows[] = {
        {"1 1 PENDING None\n", {1, 1, true, "PENDING", "None"}},
        {"6 4 PENDING Resources\n", {6, 4, true, "PENDING", "Resources"}},
        {"4 1 RUNNING None\n", {4, 1, true, "RUNNING", "None"}},
        {"5 2 COMPLETING None\n", {5, 2, true, "COMPLETING", "None"}},
        {"1 1 COMPLETED None\n", {1, 1, false, "COMPLETED", "None"}},
        {"1 3 FAILED NonZeroExitCode\n", {1, 3, false, "FAILED", "NonZeroExitCode"}},
        {"14 1 FAILED JobLaunchFailure\n", {14, 1, false, "FAILED", "JobLaunchFailure"}},
        {"9 1 PREEMPTED None\n", {9, 1, false, "PREEMPTED", "None"}},
        {"12 1 NODE_FAIL NodeDown\n", {12, 1, false, "NODE_FAIL", "NodeDown"}},
        {"6 1 CANCELLED None\n", {6, 1, false, "CANCELLED", "None"}},
        {"6 N/A CANCELLED Resources\n", {6, 0, false, "CANCELLED", "Resources"}},
        {"8 1 PENDING BeginTime\n", {8, 1, true, "PENDING", "BeginTime"}},
        {"9 2 PENDING JobHeldUser\n", {9, 2, true, "PENDING", "JobHeldUser"}},
        {"8 2 PENDING DependencyNeverSatisfied\n",
         {8, 2, true, "PENDING", "DependencyNeverSatisfied"}},
        /* longer than the field */
        {"13 1 PENDING Nodes required for job are DOWN, DRAINED or reserved for jobs in higher "
         "priority partitions\n",
         {13, 1, true, "PENDING",
          "Nodes required for job are DOWN, DRAINED or reserved for jobs i"}},
        /* from the manual squeue(1) */
        {"7 2 TIMEOUT TimeLimit\n", {7, 2, false, "TIMEOUT", "TimeLimit"}},
        {"7 2 OUT_OF_MEMORY OutOfMemory\n", {7, 2, false, "OUT_OF_MEMORY", "OutOfMemory"}},
        {"7 2 BOOT_FAIL NodeDown\n", {7, 2, false, "BOOT_FAIL", "NodeDown"}},
        {"7 2 DEADLINE DeadLine\n", {7, 2, false, "DEADLINE", "DeadLine"}},
        {"7 2 REVOKED None\n", {7, 2, false, "REVOKED", "None"}},
        {"7 2 SUSPENDED None\n", {7, 2, true, "SUSPENDED", "None"}},
        {"7 2 REQUEUED None\n", {7, 2, true, "REQUEUED", "None"}},
        {"7 2 REQUEUE_HOLD launch failed requeued held\n",
         {7, 2, true, "REQUEUE_HOLD", "launch failed requeued held"}},
        {"7 2 RUNNING\n", {7, 2, true, "RUNNING", ""}},
    };
    struct expected all[sizeof rows / sizeof *rows];
    char text[4000] = "";
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        queue_is(rows[i].line, &rows[i].task, 1);
        strcat(text, rows[i].line);
        all[i] = rows[i].task;
    }
    queue_is(text, all, sizeof rows / sizeof *rows);
    queue_is("", NULL, 0); /* no task of this name */
    /* lines that are about no task */
    const struct expected two[] = {{7, 2, true, "RUNNING", ""}, {8, 1, false, "FAILED", "None"}};
    queue_is("squeue: warning: slow\n7 1\n\n7 2 RUNNING\n8 1 FAILED None\n", two, 2);
}

/* ---- submitting ---- */

TEST(submissions)
{
    static const struct {
        const char *output, *complaint;
        int code;
        long job; /* 0: none */
        const char *error;
    } rows[] = {
        {"1\n", "", 0, 1, NULL},
        {"17;cluster\n", "", 0, 17, NULL},
        {"2147483647\n", "", 0, 2147483647, NULL},
        {"", "", 0, 0, "sbatch answers '', no number"},
        {"0\n", "", 0, 0, "sbatch answers '0"},
        {"-3\n", "", 0, 0, "sbatch answers '-3"},
        {"Submitted batch job 11\n", "", 0, 0, "sbatch answers 'Submitted batch job 11"},
        {"", "sbatch: error: invalid partition specified: none", 1, 0,
         "sbatch failed (exit status 1): sbatch: error: invalid partition specified: none"},
        {"", "", 2, 0, "sbatch failed (exit status 2): it says nothing"},
        {"5\n", "sbatch: unrecognized option '--nonsense'", 255, 0,
         "sbatch failed (exit status 255): sbatch: unrecognized option '--nonsense'"},
    };
    const char *const words[] = {"sbatch", "--parsable", "--array=1-3", "a b", NULL};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct error error = {0};
        long job = -1;
        command_says("sbatch", rows[i].output, rows[i].complaint, rows[i].code);
        assert_int_equal(slurm_submit(words, &job, &error),
                         rows[i].job ? STATUS_OK : STATUS_ENVIRONMENT);
        assert_string_equal(arguments_of("sbatch"), "[--parsable][--array=1-3][a b]");
        if (rows[i].job) {
            assert_int_equal(job, rows[i].job);
        } else {
            assert_int_equal(error.status, STATUS_ENVIRONMENT);
            assert_non_null(strstr(error.message, rows[i].error));
        }
    }
}
