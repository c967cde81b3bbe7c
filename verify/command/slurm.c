/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slurm.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "list.h"

/* Runs one of Slurm's commands. On success the caller frees said. error may be NULL. */
static enum status ask(const char *const *words, struct child_said *said, struct error *error)
{
    struct error trouble = {0};
    if (child_run(words, said, &trouble))
        return error_set(
            error, STATUS_ENVIRONMENT,
            "--engine slurm: no command %.200s (sbatch, squeue and scancel are needed, "
            "on a machine that may submit jobs)",
            trouble.message);
    if (said->exit == 0) return STATUS_OK;
    child_free(said);
    return error_set(error, STATUS_ENVIRONMENT, "--engine slurm: %s failed (exit status %d): %s",
                     words[0], said->exit,
                     said->complaint[0] ? said->complaint : "it says nothing");
}

enum status slurm_submit(const char *const *words, long *job, struct error *error)
{
    struct child_said said;
    if (ask(words, &said, error)) return STATUS_ENVIRONMENT;
    *job = strtol(said.output, NULL, 10); /* "17", or "17;cluster"; 0: no number */
    const bool sound = *job > 0;
    if (!sound)
        error_set(error, STATUS_ENVIRONMENT, "--engine slurm: sbatch answers '%.60s', no number",
                  said.output);
    child_free(&said);
    return sound ? STATUS_OK : STATUS_ENVIRONMENT;
}

static bool ended(const char *state)
{
    static const char *const ends[] = {"BOOT_FAIL", "CANCELLED", "COMPLETED",     "DEADLINE",
                                       "FAILED",    "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED",
                                       "REVOKED",   "TIMEOUT"};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++)
        if (strcmp(state, ends[i]) == 0) return true;
    return false;
}

enum status slurm_queue(const char *name, struct slurm_task **tasks, size_t *count,
                        struct error *error)
{
    char named[80];
    struct child_said said;
    const char *words[] = {"squeue", "--noheader",           "--array", "--states=all",
                           named,    "--format=%F %K %T %r", NULL};
    snprintf(named, sizeof named, "--name=%s", name);
    *tasks = NULL;
    *count = 0;
    if (ask(words, &said, error)) return STATUS_ENVIRONMENT;
    enum status status = STATUS_OK;
    for (char *line = said.output; *line && !status;) {
        struct slurm_task task = {0};
        const size_t length = strcspn(line, "\n");
        const bool last = !line[length];
        line[length] = '\0';
        char index[16] = ""; /* "N/A": see slurm.h */
        if (sscanf(line, "%ld %15s %23s %63[^\n]", &task.job, index, task.state, task.reason) >=
            3) {
            task.index = atoi(index);
            task.live = !ended(task.state);
            if (list_grow(tasks, *count, sizeof task))
                (*tasks)[(*count)++] = task;
            else
                status = error_set(error, STATUS_ENVIRONMENT, "no memory for a queue");
        }
        line += length + !last;
    }
    child_free(&said);
    return status;
}

static enum status cancel(const char *what, struct error *error)
{
    struct child_said said;
    const char *words[] = {"scancel", what, NULL};
    if (ask(words, &said, error)) return STATUS_ENVIRONMENT;
    child_free(&said);
    return STATUS_OK;
}

enum status slurm_cancel(const char *name, struct error *error)
{
    char named[80];
    snprintf(named, sizeof named, "--name=%s", name);
    return cancel(named, error);
}

enum status slurm_cancel_task(const struct slurm_task *task, struct error *error)
{
    char number[80];
    snprintf(number, sizeof number, "%ld_%d", task->job, task->index);
    return cancel(number, error);
}
