/* SPDX-License-Identifier: GPL-3.0-or-later */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "slurm.h"

enum { PATH_LENGTH = 4096 };

void slurm_share_log(const char *folder, const char *name, long job, int share, char *path,
                     size_t size)
{
    snprintf(path, size, "%s/%s-%ld_%d.log", folder, name, job, share);
}

/* True for options that a share does not get: destinations of results and the choice of the
 * engine. */
static bool of_the_caller(const char *name)
{
    static const char *const names[] = {"engine",  "engine-options", "engine-tasks", "failures",
                                        "history", "jobs",           "junit",        "list",
                                        "plot",    "resume"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

static bool takes(const struct command *command, const char *name)
{
    for (size_t i = 0; command->options[i].name; i++)
        if (strcmp(command->options[i].name, name) == 0) return true;
    return false;
}

/* Writes a word quoted for the shell. */
static void put_quoted(FILE *line, const char *word)
{
    fputc('\'', line);
    for (; *word; word++) {
        if (*word == '\'')
            fputs("'\\''", line);
        else
            fputc(*word, line);
    }
    fputc('\'', line);
}

/* The command line of a share; malloced. */
static char *line_of(const struct slurm_work *work, int of)
{
    const struct options *options = work->options;
    const struct command_option *list = options->command->options;
    char program[PATH_LENGTH] = "", *text = NULL;
    size_t size;
    (void)!readlink("/proc/self/exe", program, sizeof program - 1); /* stays empty without /proc */
    FILE *line = open_memstream(&text, &size);
    if (!line) return NULL;
    fputs("exec ", line);
    put_quoted(line, *program ? program : "sphproof");
    fprintf(line, " %s --shard $SLURM_ARRAY_TASK_ID/%d --only-build %s --threads %d",
            options->command->name, of, work->cache->build, options->threads);
    if (takes(options->command, "jobs")) fprintf(line, " --jobs %d", work->jobs);
    for (size_t i = 0; list[i].name; i++) {
        if (!options->values[i] || of_the_caller(list[i].name)) continue;
        fprintf(line, list[i].argument ? " --%s=" : " --%s", list[i].name);
        if (list[i].argument) put_quoted(line, options->values[i]);
    }
    fputs(" --", line);
    for (int i = 0; i < options->count; i++) {
        fputc(' ', line);
        put_quoted(line, options->arguments[i]);
    }
    return fclose(line) ? free(text), NULL : text;
}

enum status slurm_share_submit(const struct slurm_work *work, int of, const char *which,
                               const char *array_name, const char *folder, long *job,
                               struct error *error)
{
    const char *words[SLURM_WORDS_MAX + 1] = {"sbatch", "--requeue", "--open-mode=append"};
    char cpus[40], array[16 + strlen(which)], name[80], output[PATH_LENGTH + 200];
    const char *given = options_value(work->options, "engine-options");
    char *own = strdup(given ? given : ""), *rest = NULL, *wrap = line_of(work, of);
    size_t n = 3;
    snprintf(cpus, sizeof cpus, "--cpus-per-task=%d", work->jobs * work->options->threads);
    snprintf(name, sizeof name, "--job-name=%s", array_name);
    snprintf(array, sizeof array, "--array=%s", which);
    snprintf(output, sizeof output, "--output=%s/%s-%%A_%%a.log", folder, array_name);
    words[n++] = cpus;
    enum status status =
        own && wrap ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for sbatch");
    char *word = own ? strtok_r(own, " \t\n", &rest) : NULL;
    for (; word && n < SLURM_WORDS_MAX - 6; word = strtok_r(NULL, " \t\n", &rest))
        words[n++] = word;
    if (word)
        status = error_set(error, STATUS_BAD_INPUT, "--engine-options: more than %d words",
                           SLURM_WORDS_MAX - 10);
    const char *const last[] = {"--parsable", name, array, output, "--wrap", wrap};
    memcpy(&words[n], last, sizeof last); /* the last setting of an option applies */
    if (!status) status = slurm_submit(words, job, error);
    free(own);
    free(wrap);
    return status;
}
