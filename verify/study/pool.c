/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pool.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "list.h"
#include "result.h"

enum { POLL_MS = 200, CHUNK = 1 << 16 };

/* A job in its own process; text: what its pipe has delivered so far. */
struct worker {
    pid_t pid;
    int pipe;
    size_t job, length;
    char *text;
};

size_t pool_add(struct pool *pool, const char *name, const char *key, double weight,
                pool_compute *compute, const void *context)
{
    const size_t known = pool_find(pool, key);
    if (known != (size_t)-1) return known;
    if (!pool->numbers) pool->numbers = json_object();
    if (json_object_set_new(pool->numbers, key, json_integer((json_int_t)pool->count)))
        return (size_t)-1;
    if (!list_grow(&pool->jobs, pool->count, sizeof *pool->jobs)) return (size_t)-1;
    struct pool_job job = {.name = strdup(name), .key = strdup(key), .weight = weight};
    if (!job.name || !job.key) {
        free(job.name);
        free(job.key);
        return (size_t)-1;
    }
    job.compute = compute;
    job.context = context;
    pool->jobs[pool->count] = job;
    return pool->count++;
}

size_t pool_find(const struct pool *pool, const char *key)
{
    const json_t *number = json_object_get(pool->numbers, key);
    return number ? (size_t)json_integer_value(number) : (size_t)-1;
}

void pool_free(struct pool *pool)
{
    for (size_t i = 0; i < pool->count; i++) {
        free(pool->jobs[i].name);
        free(pool->jobs[i].key);
        json_decref(pool->jobs[i].document);
    }
    free(pool->jobs);
    json_decref(pool->numbers);
    *pool = (struct pool){0};
}

/* ---- in the worker's process ---- */

void pool_end_with_parent(void)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
}

/* {"status", "message", "document", "note"}: the job's result, and why the cache could not keep
 * it. */
static json_t *reply_of(const struct pool_job *job, const struct cache *cache)
{
    json_t *document = NULL;
    struct error error = {0}, trouble = {0};
    const enum status status = job->compute(job->context, &document, &error);
    json_t *reply =
        result_object("status=%d message=%s document=%p", (int)status, status ? error.message : "",
                      (void *)(document ? document : json_null()));
    const bool result = status != STATUS_ENVIRONMENT && status != STATUS_BAD_INPUT;
    if (reply && result && cache && cache_store(cache, job->key, reply, &trouble))
        result_add(reply, "note=%s", trouble.message);
    return reply;
}

static _Noreturn void work(const struct pool_job *job, const struct cache *cache, int pipe)
{
    json_t *reply = reply_of(job, cache);
    char *text = reply ? result_text(reply) : NULL;
    size_t sent = 0, length = text ? strlen(text) : 0;
    while (sent < length) {
        const ssize_t n = write(pipe, text + sent, length - sent);
        if (n < 0 && errno != EINTR) _exit(STATUS_ENVIRONMENT);
        if (n > 0) sent += (size_t)n;
    }
    _exit(length ? 0 : STATUS_ENVIRONMENT);
}

/* ---- in the parent ---- */

/* True if the job broke down and may succeed at another attempt. */
static bool failed(const struct pool_job *job, const json_t *reply)
{
    return job->fickle && json_integer_value(json_object_get(reply, "status")) == STATUS_BROKE_DOWN;
}

static bool take_reply(struct pool *pool, struct pool_job *job, json_t *reply)
{
    json_t *status = json_object_get(reply, "status"), *document;
    if (!json_is_integer(status)) return false;
    job->error.status = (enum status)json_integer_value(status);
    const char *message = json_string_value(json_object_get(reply, "message"));
    snprintf(job->error.message, sizeof job->error.message, "%s", message ? message : "");
    document = json_object_get(reply, "document");
    job->document = json_is_null(document) ? NULL : json_incref(document);
    const char *note = json_string_value(json_object_get(reply, "note"));
    if (note && !pool->note[0]) snprintf(pool->note, sizeof pool->note, "%s", note);
    return job->done = true;
}

static enum status start(struct worker *worker, const struct pool *pool, size_t job,
                         const struct pool_settings *settings, struct error *error)
{
    int ends[2];
    fflush(NULL);
    if (pipe(ends))
        return error_set(error, STATUS_ENVIRONMENT, "no pipe for %s: %s", pool->jobs[job].name,
                         strerror(errno));
    const pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        work(&pool->jobs[job], settings->cache, ends[1]);
    }
    const int reason = errno;
    close(ends[1]);
    if (pid < 0) {
        close(ends[0]);
        return error_set(error, STATUS_ENVIRONMENT, "no process for %s: %s", pool->jobs[job].name,
                         strerror(reason));
    }
    *worker = (struct worker){.pid = pid, .pipe = ends[0], .job = job};
    return STATUS_OK;
}

/* Reads the available bytes without waiting; false at the end. */
static bool receive(struct worker *worker)
{
    char *text = realloc(worker->text, worker->length + CHUNK);
    if (!text) return false; /* half a reply is useless */
    worker->text = text;
    const ssize_t n = read(worker->pipe, text + worker->length, CHUNK);
    if (n <= 0) return false;
    worker->length += (size_t)n;
    return true;
}

static void finish(struct worker *worker, struct pool *pool)
{
    struct pool_job *job = &pool->jobs[worker->job];
    int status = 0;
    close(worker->pipe);
    while (waitpid(worker->pid, &status, 0) < 0 && errno == EINTR) continue;
    json_t *reply = worker->text ? json_loadb(worker->text, worker->length, 0, NULL) : NULL;
    job->crashed = WIFSIGNALED(status);
    if (job->crashed)
        error_set(&job->error, STATUS_BROKE_DOWN, "%s: its process was ended by signal %d (%s)",
                  job->name, WTERMSIG(status), strsignal(WTERMSIG(status)));
    else if (!WIFEXITED(status) || WEXITSTATUS(status) || !take_reply(pool, job, reply))
        error_set(&job->error, STATUS_ENVIRONMENT, "%s: its process gave no result: no memory?",
                  job->name);
    job->done = true;
    json_decref(reply);
    free(worker->text);
    *worker = (struct worker){.pid = 0};
}

static const struct pool_job *sorted_jobs;

static int heavy_first(const void *a, const void *b)
{
    const size_t i = *(const size_t *)a, j = *(const size_t *)b;
    const double x = sorted_jobs[i].weight, y = sorted_jobs[j].weight;
    return x != y ? (x < y) - (x > y) : (i > j) - (i < j);
}

/* A total order that does not depend on the order in which jobs were added. */
static int heavy_first_by_key(const void *a, const void *b)
{
    const struct pool_job *x = &sorted_jobs[*(const size_t *)a],
                          *y = &sorted_jobs[*(const size_t *)b];
    if (x->weight != y->weight) return (x->weight < y->weight) - (x->weight > y->weight);
    return strcmp(x->key, y->key);
}

enum status pool_divide(const struct pool *pool, int of, int *shares, struct error *error)
{
    size_t *order = calloc(pool->count, sizeof *order);
    double *load = calloc((size_t)of, sizeof *load);
    for (size_t i = 0; order && i < pool->count; i++) order[i] = i;
    sorted_jobs = pool->jobs;
    if (order && load) qsort(order, pool->count, sizeof *order, heavy_first_by_key);
    for (size_t k = 0; order && load && k < pool->count; k++) {
        const struct pool_job *job = &pool->jobs[order[k]];
        int share = 0;
        for (int s = 1; s < of; s++)
            if (load[s] < load[share]) share = s;
        load[share] += job->weight;
        shares[order[k]] = share + 1;
    }
    const bool sound = order && load;
    free(order);
    free(load);
    return sound ? STATUS_OK : error_set(error, STATUS_ENVIRONMENT, "no memory for %d shares", of);
}

/* Leaves out the jobs of other shares. */
static enum status take_share(struct pool *pool, const struct pool_share *mine, struct error *error)
{
    if (!mine->of) return STATUS_OK;
    int *shares = calloc(pool->count, sizeof *shares);
    if (!shares) return error_set(error, STATUS_ENVIRONMENT, "no memory for %d shares", mine->of);
    const enum status status = pool_divide(pool, mine->of, shares, error);
    for (size_t i = 0; i < pool->count && !status; i++)
        pool->jobs[i].elsewhere = shares[i] != mine->number;
    free(shares);
    return status;
}

struct course {
    size_t *order, next, ready; /* jobs by falling weight; index of the next; number done */
    double work, worked;        /* total weight that the cache lacks; the part of it that is done */
    const char *last;
};

/* Takes results from the cache and queues the other jobs, the heaviest first. */
static size_t look_up(struct pool *pool, const struct pool_settings *settings,
                      struct course *course)
{
    size_t waiting = 0;
    for (size_t i = 0; i < pool->count; i++) {
        struct pool_job *job = &pool->jobs[i];
        bool damaged = false;
        if (job->elsewhere) continue;
        json_t *reply = settings->cache ? cache_load(settings->cache, job->key, &damaged) : NULL;
        pool->damaged += damaged;
        job->cached =
            reply && !(settings->again && failed(job, reply)) && take_reply(pool, job, reply);
        json_decref(reply);
        pool->found += job->cached;
        course->ready += job->cached;
        if (job->cached) continue;
        course->work += job->weight;
        course->order[waiting++] = i;
    }
    sorted_jobs = pool->jobs;
    qsort(course->order, waiting, sizeof *course->order, heavy_first);
    return waiting;
}

static void report(const struct pool *pool, const struct pool_settings *settings,
                   const struct course *course)
{
    if (settings->progress && course->last)
        settings->progress(settings->progress_context, course->last, course->ready, pool->count,
                           course->work > 0 ? fmin(course->worked / course->work, 1) : 1);
}

static enum status run_workers(struct pool *pool, const struct pool_settings *settings,
                               struct course *course, size_t waiting, struct worker *workers,
                               struct pollfd *polls, struct error *error)
{
    enum status status = STATUS_OK;
    int running = 0;
    while (running || (course->next < waiting && !status)) {
        while (running < settings->jobs && course->next < waiting && !status) {
            const size_t job = course->order[course->next++];
            course->last = pool->jobs[job].name;
            if (!(status = start(&workers[running], pool, job, settings, error))) running++;
        }
        for (int i = 0; i < running; i++)
            polls[i] = (struct pollfd){.fd = workers[i].pipe, .events = POLLIN};
        poll(polls, (nfds_t)running, POLL_MS);
        for (int i = running; i-- > 0;) {
            if (!polls[i].revents || receive(&workers[i])) continue;
            course->worked += pool->jobs[workers[i].job].weight;
            course->ready++;
            finish(&workers[i], pool);
            workers[i] = workers[--running]; /* the moved worker has been polled */
        }
        report(pool, settings, course);
    }
    return status;
}

enum status pool_run(struct pool *pool, const struct pool_settings *settings, struct error *error)
{
    struct course course = {.order = calloc(pool->count, sizeof *course.order)};
    struct worker *workers = calloc((size_t)settings->jobs, sizeof *workers);
    struct pollfd *polls = calloc((size_t)settings->jobs, sizeof *polls);
    enum status status = STATUS_OK;
    json_object_seed(0);
    if (course.order && workers && polls && !(status = take_share(pool, &settings->share, error))) {
        const size_t waiting = look_up(pool, settings, &course);
        status = run_workers(pool, settings, &course, waiting, workers, polls, error);
    } else if (!status) {
        status =
            error_set(error, STATUS_ENVIRONMENT, "no memory for %zu computations", pool->count);
    }
    free(course.order);
    free(workers);
    free(polls);
    return status;
}
