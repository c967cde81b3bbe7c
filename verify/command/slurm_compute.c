/* SPDX-License-Identifier: GPL-3.0-or-later
 * --engine slurm: computes the shares (--shard) of a study as Slurm tasks that fill the cache.
 *
 * A share is submitted if the cache lacks some of its results and no task works on it, at most
 * three times, and not again if its user cancelled it. The same command, called again, therefore
 * attaches to the running tasks. Between calls a small file stores the number of shares and how
 * often each was submitted. The array is named after a hash of the study's computations and the
 * cache's folder. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <time.h>
#include <unistd.h>

#include "clock.h"
#include "output.h"
#include "result.h"
#include "slurm.h"

enum { TRIES = 3, SHOWN = 10, LINE = 400 };

/* seconds */
static const double first_look = 0.5, last_look = 15, visible = 30, controller_away = 120;
static const double least_s = 600; /* shorter tasks burden a scheduler */

static volatile sig_atomic_t interrupted;

static void note_interrupt(int number)
{
    (void)number;
    interrupted = true;
}

struct share {
    size_t lacking; /* computations that the cache does not have */
    int tries;      /* number of submissions */
    bool live, failed;
    double ended;   /* time at which its end was first seen; 0: not yet */
    long job;       /* its last array */
    char state[24]; /* of its last task; "" before */
};

struct array {
    const struct slurm_work *work;
    char name[32], folder[CACHE_PATH_MAX + 8], state[CACHE_PATH_MAX + 64];
    int count;            /* of shares */
    struct share *shares; /* [1..count] */
    int *of;              /* share of each job of the pool; 0: computed */
    size_t lacking, wanted;
    double left, whole; /* estimated seconds of the missing results: now, at the start */
    double looked;      /* duration of the last search of the cache */
    size_t waiting, running;
    bool heard;  /* the controller has answered before */
    double away; /* time since which it has not answered; 0: it answers */
};

/* ---- state of the study ---- */

static enum status name_array(struct array *array, struct error *error)
{
    const struct pool *pool = array->work->pool;
    const struct cache *cache = array->work->cache;
    char *real = realpath(cache->folder, NULL);
    if (!real)
        return error_set(error, STATUS_ENVIRONMENT, "%.400s: %s", cache->folder, strerror(errno));
    uint64_t hash = cache_hash(CACHE_HASH, cache->build, strlen(cache->build));
    hash = cache_hash(hash, real, strlen(real));
    for (size_t i = 0; i < pool->count; i++)
        hash = cache_hash(hash, pool->jobs[i].key, strlen(pool->jobs[i].key));
    snprintf(array->folder, sizeof array->folder, "%s/slurm", real);
    free(real);
    snprintf(array->name, sizeof array->name, "sphproof-%016" PRIx64, hash);
    snprintf(array->state, sizeof array->state, "%s/%s.json", array->folder, array->name);
    return output_folder(array->folder, error);
}

/* {"tasks": shares, "tries": [...], "jobs": [arrays ...]} from an earlier call; NULL: none. */
static json_t *load(const struct array *array)
{
    json_t *state = json_load_file(array->state, 0, NULL);
    const json_int_t tasks = json_integer_value(json_object_get(state, "tasks"));
    const json_t *tries = json_object_get(state, "tries"), *jobs = json_object_get(state, "jobs");
    if (tasks >= 1 && tasks <= SLURM_TASKS_MAX && json_array_size(tries) == (size_t)tasks &&
        json_array_size(jobs) == (size_t)tasks)
        return state;
    json_decref(state);
    return NULL;
}

static void remember(struct array *array, const json_t *state)
{
    for (int s = 1; s <= array->count; s++) {
        const size_t i = (size_t)s - 1;
        array->shares[s].tries =
            (int)json_integer_value(json_array_get(json_object_get(state, "tries"), i));
        array->shares[s].job =
            (long)json_integer_value(json_array_get(json_object_get(state, "jobs"), i));
    }
}

/* Reads what another call may have submitted since. */
static enum status refresh(struct array *array, struct error *error)
{
    json_t *state = load(array);
    const json_int_t tasks = json_integer_value(json_object_get(state, "tasks"));
    const bool same = !state || tasks == array->count;
    if (same) remember(array, state);
    json_decref(state);
    return same ? STATUS_OK
                : error_set(error, STATUS_ENVIRONMENT,
                            "another call has divided this study anew: call again to attach to it");
}

static enum status save(const struct array *array, struct error *error)
{
    json_t *tries = json_array(), *jobs = json_array();
    for (int s = 1; s <= array->count; s++) {
        json_array_append_new(tries, json_integer(array->shares[s].tries));
        json_array_append_new(jobs, json_integer(array->shares[s].job));
    }
    json_t *state =
        json_pack("{s:i, s:o, s:o}", "tasks", array->count, "tries", tries, "jobs", jobs);
    const enum status status = result_write(state, array->state, error);
    json_decref(state);
    return status;
}

/* Updates which results the cache still lacks. */
static void look(struct array *array)
{
    const struct pool *pool = array->work->pool;
    const double began = clock_wall();
    for (int s = 1; s <= array->count; s++) array->shares[s].lacking = 0;
    array->lacking = 0;
    array->left = 0;
    for (size_t i = 0; i < pool->count; i++) {
        if (!array->of[i]) continue;
        if (cache_has(array->work->cache, pool->jobs[i].key)) {
            array->of[i] = 0;
            continue;
        }
        array->shares[array->of[i]].lacking++;
        array->lacking++;
        array->left += pool->jobs[i].weight;
    }
    array->looked = clock_wall() - began;
}

/* Number of shares of a study: at least ten minutes each, if jobs processes work on `seconds` of
 * `count` computations; at least 1. */
static int tasks_for(double seconds, size_t count, int jobs)
{
    const double most = fmin((double)count, SLURM_TASKS_MAX);
    return (int)fmax(1, fmin(seconds / (least_s * jobs), most));
}

static enum status divide(struct array *array, struct error *error)
{
    const struct slurm_work *work = array->work;
    const struct pool *pool = work->pool;
    size_t lacking = 0;
    for (size_t i = 0; i < pool->count; i++) {
        const struct pool_job *job = &pool->jobs[i];
        if (cache_has(work->cache, job->key)) continue;
        array->whole += job->weight;
        lacking++;
    }
    array->wanted = lacking;
    if (!lacking) return STATUS_OK;
    json_t *state = load(array); /* a resumed study keeps its shares */
    array->count = state         ? (int)json_integer_value(json_object_get(state, "tasks"))
                   : work->tasks ? work->tasks
                                 : tasks_for(array->whole, lacking, work->jobs);
    array->shares = calloc((size_t)array->count + 1, sizeof *array->shares);
    array->of = calloc(pool->count, sizeof *array->of);
    json_decref(state);
    if (!array->shares || !array->of)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %d shares", array->count);
    return pool_divide(pool, array->count, array->of, error);
}

/* ---- submitting ---- */

/* Numbers of the chosen shares, as sbatch takes them: 1,3-5; malloced. */
static char *ranges(const struct array *array, const bool *chosen)
{
    char *text = NULL;
    size_t size;
    FILE *line = open_memstream(&text, &size);
    if (!line) return NULL;
    for (int end = 0; end++ < array->count;) {
        const int s = end;
        while (end <= array->count && chosen[end]) end++;
        if (end == s) continue;
        fprintf(line, "%s%d", ftell(line) > 0 ? "," : "", s);
        if (end - 1 > s) fprintf(line, "-%d", end - 1);
    }
    return fclose(line) ? free(text), NULL : text;
}

static enum status submit(struct array *array, const bool *chosen, struct error *error)
{
    long job;
    if (output_probe(array->state, error)) return error->status;
    for (int s = 1; s <= array->count; s++) array->shares[s].tries += chosen[s];
    if (save(array, error))
        return error->status; /* saved first, so that every submission is counted */
    char *which = ranges(array, chosen);
    const enum status status = which ? slurm_share_submit(array->work, array->count, which,
                                                          array->name, array->folder, &job, error)
                                     : error_set(error, STATUS_ENVIRONMENT, "no memory for shares");
    free(which);
    for (int s = 1; s <= array->count; s++) {
        struct share *one = &array->shares[s];
        if (!chosen[s]) continue;
        if (status) {
            one->tries--;
            continue;
        }
        one->job = job;
        one->live = true;
        one->state[0] = '\0';
        one->ended = 0;
    }
    struct error unsaid; /* the first error counts */
    const enum status saved = save(array, status ? &unsaid : error);
    return status ? status : saved;
}

/* ---- watching ---- */

/* True for a task that Slurm holds because it could not start it; it would wait for ever. */
static bool held(const struct slurm_task *task)
{
    return task->live && strstr(task->reason, "launch failed");
}

/* Slurm lists all tasks that waited when their array was cancelled as one, without a number. */
static void hear_cancelled(struct array *array, const struct slurm_task *task)
{
    for (int s = 1; s <= array->count; s++) {
        struct share *share = &array->shares[s];
        const bool waited = !share->state[0] || strcmp(share->state, "PENDING") == 0;
        if (share->job == task->job && !share->live && waited)
            snprintf(share->state, sizeof share->state, "%s", task->state);
    }
}

static void hear(struct array *array, struct slurm_task *tasks, size_t count)
{
    array->waiting = array->running = 0;
    for (int s = 1; s <= array->count; s++) array->shares[s].live = false;
    for (size_t i = 0; i < count; i++) {
        struct slurm_task *task = &tasks[i];
        if (held(task)) task->live = slurm_cancel_task(task, NULL) != STATUS_OK;
        if (task->index < 1 || task->index > array->count) continue;
        struct share *share = &array->shares[task->index];
        if (task->live) {
            array->running += strcmp(task->state, "RUNNING") == 0;
            array->waiting += strcmp(task->state, "PENDING") == 0;
        }
        if (!task->live && (share->live || task->job < share->job)) continue;
        share->live = task->live;
        share->job = task->job;
        snprintf(share->state, sizeof share->state, "%s", task->state);
    }
    for (size_t i = 0; i < count; i++)
        if (tasks[i].index == 0 && !tasks[i].live) hear_cancelled(array, &tasks[i]);
}

/* True if the rest of this share must be submitted now; marks a share that is given up. */
static bool due(struct array *array, struct share *share, int number)
{
    const double now = clock_wall();
    if (!share->lacking || share->live || share->failed) return false;
    if (!share->tries) return true; /* regardless of an earlier call's tasks */
    if (share->ended <= 0) share->ended = now;
    /* a completed task has written all results, but other machines may see them a little later */
    if (strcmp(share->state, "COMPLETED") == 0 && now < share->ended + visible) return false;
    if (share->tries >= TRIES || strcmp(share->state, "CANCELLED") == 0) {
        share->failed = true; /* cancelled by its user, or submitted too often */
        return false;
    }
    if (!array->work->options->quiet)
        fprintf(stderr,
                "sphproof: note: share %d ended (%s) and %zu of its computations are missing: "
                "submitted again (%d of %d)\n",
                number, share->state[0] ? share->state : "not in the queue", share->lacking,
                share->tries, TRIES - 1);
    return true;
}

static enum status act(struct array *array, struct error *error)
{
    bool *chosen = calloc((size_t)array->count + 1, sizeof *chosen);
    size_t number = 0;
    if (!chosen) return error_set(error, STATUS_ENVIRONMENT, "no memory for shares");
    for (int s = 1; s <= array->count; s++) number += chosen[s] = due(array, &array->shares[s], s);
    const enum status status = number ? submit(array, chosen, error) : STATUS_OK;
    free(chosen);
    return status;
}

/* Waits for a controller that restarts, unless it has never answered. */
static enum status be_patient(struct array *array, const struct error *trouble, struct error *error)
{
    const double now = clock_wall();
    if (array->away <= 0) {
        array->away = now;
        if (!array->work->options->quiet)
            fprintf(stderr, "sphproof: note: %s; trying again\n", trouble->message);
    }
    if (array->heard && now < array->away + controller_away) return STATUS_OK;
    *error = *trouble;
    return error->status;
}

/* Polls the cache and the queue and acts on the result. Of several processes that watch one study,
 * one acts at a time. */
static enum status step(struct array *array, struct error *error)
{
    struct slurm_task *tasks = NULL;
    size_t count;
    const int lock = open(array->folder, O_RDONLY | O_CLOEXEC);
    flock(lock, LOCK_EX); /* without a lock where the folder cannot be opened */
    struct error trouble;
    enum status status = refresh(array, error);
    const bool answers = !status && !slurm_queue(array->name, &tasks, &count, &trouble);
    look(array); /* after the queue, since tasks that it lists as ended have written all results */
    if (answers) {
        array->heard = true;
        array->away = 0;
        hear(array, tasks, count);
        if (array->lacking) status = act(array, error);
    } else if (!status && array->lacking) {
        status = be_patient(array, &trouble, error);
    }
    free(tasks);
    close(lock);
    return status;
}

static bool over(const struct array *array)
{
    for (int s = 1; s <= array->count; s++)
        if (array->shares[s].lacking && !array->shares[s].failed) return false;
    return true;
}

static void wait_for(double seconds)
{
    const struct timespec time = {(time_t)seconds, (long)(1e9 * (seconds - floor(seconds)))};
    nanosleep(&time, NULL); /* an interrupt ends it */
}

static void show(struct array *array)
{
    static char what[80];
    snprintf(what, sizeof what, "%s, slurm: %zu run, %zu wait", array->work->options->command->name,
             array->running, array->waiting);
    array->work->progress->what = what;
    progress_share(array->work->progress, array->wanted - array->lacking, array->wanted,
                   1 - array->left / array->whole);
}

static enum status watch(struct array *array, struct error *error)
{
    const double began = clock_wall();
    while (!interrupted) {
        if (step(array, error)) return error->status;
        if (over(array)) return STATUS_OK;
        show(array);
        /* waits a twentieth of the elapsed time; at most 1 % of the time goes into polling */
        const double wait = fmin(fmax((clock_wall() - began) / 20, 1.01 * first_look), last_look);
        wait_for(fmax(wait, 100 * array->looked));
    }
    return STATUS_OK;
}

/* ---- the end ---- */

/* The last line that is not blank. */
static void last_line(const char *path, char line[LINE])
{
    char part[LINE];
    FILE *file = fopen(path, "r");
    snprintf(line, LINE, "%s", file ? "(empty)" : "(there is none)");
    while (file && fgets(part, sizeof part, file))
        if (part[strspn(part, " \n")]) snprintf(line, LINE, "%.*s", (int)strcspn(part, "\n"), part);
    if (file) fclose(file);
    status_clean(line);
}

/* Reports the missing computations and the log files, which are kept. */
static enum status give_up(const struct array *array, struct error *error)
{
    const struct pool *pool = array->work->pool;
    size_t shares = 0, shown = 0;
    char line[LINE], path[sizeof array->folder + 96];
    for (int s = 1; s <= array->count; s++) {
        const struct share *share = &array->shares[s];
        if (!share->lacking || shares++ >= SHOWN) continue;
        slurm_share_log(array->folder, array->name, share->job, s, path, sizeof path);
        last_line(path, line);
        fprintf(stderr, "sphproof: share %d of %d (%s, submitted %d times), log %s: %s\n", s,
                array->count, share->state[0] ? share->state : "not in the queue", share->tries,
                path, line);
    }
    for (size_t i = 0; i < pool->count; i++)
        if (array->of[i] && shown++ < SHOWN)
            fprintf(stderr, "sphproof: missing: %s (share %d)\n", pool->jobs[i].name, array->of[i]);
    unlink(array->state); /* the next call divides the missing results into new shares */
    return error_set(error, STATUS_ENVIRONMENT,
                     "--engine slurm: %zu computations are missing; what is done is kept in %.200s",
                     array->lacking, array->work->cache->folder);
}

/* After an interrupt: asks whether the tasks shall continue. */
static enum status leave(struct array *array, struct error *error)
{
    int answer = 'n';
    const size_t tasks = array->running + array->waiting;
    if (isatty(STDIN_FILENO)) {
        fprintf(stderr, "\r\033[KCancel the %zu tasks of %s? They go on otherwise. [y/N] ", tasks,
                array->name);
        answer = getchar();
    }
    if (answer != 'y' && answer != 'Y')
        return error_set(error, STATUS_ENVIRONMENT,
                         "interrupted; %zu tasks go on: the same command attaches to them again, "
                         "scancel --name=%s ends them",
                         tasks, array->name);
    if (slurm_cancel(array->name, error)) return error->status;
    unlink(array->state);
    return error_set(error, STATUS_ENVIRONMENT,
                     "interrupted; its tasks are cancelled, what is done is kept in %.300s",
                     array->work->cache->folder);
}

static enum status finish(struct array *array, struct error *error)
{
    if (array->lacking) return give_up(array, error);
    if (array->running || array->waiting) slurm_cancel(array->name, NULL); /* not needed */
    for (int s = 1; s <= array->count; s++) {
        char path[sizeof array->folder + 96];
        slurm_share_log(array->folder, array->name, array->shares[s].job, s, path, sizeof path);
        unlink(path);
    }
    unlink(array->state);
    return STATUS_OK;
}

enum status slurm_compute(const struct slurm_work *work, struct error *error)
{
    struct array array = {.work = work};
    enum status status = name_array(&array, error);
    if (!status) status = divide(&array, error);
    if (!status && array.wanted) {
        struct sigaction before, now = {.sa_handler = note_interrupt};
        interrupted = 0;
        sigaction(SIGINT, &now, &before);
        status = watch(&array, error);
        sigaction(SIGINT, &before, NULL);
        if (!status) status = interrupted ? leave(&array, error) : finish(&array, error);
    }
    free(array.shares);
    free(array.of);
    return status;
}
