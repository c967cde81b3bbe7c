/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_scaling.h"

#include <gsl/gsl_fit.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench_skips.h"
#include "precision.h"

/* The time of a step is the difference between a longer and a shorter run, which cancels the
 * set-up. The solver asks every 32 steps whether to continue. */
enum { STEPS_SHORT = 32, STEPS_LONG = 160 };
/* Threads are compared by wall time, which other load disturbs most; therefore not by a difference
 * of two times, but by a run so long that its set-up matters little. */
enum { STEPS_THREADS = 320 };
enum { RUN_N_MAX = 10000 }; /* whole runs cost as n^2 */
static const size_t thread_n[] = {800, 6400, 20000, 100000};
enum { THREAD_LEVELS = sizeof thread_n / sizeof *thread_n };

enum part { PART_SHORT, PART_LONG, PART_RUN, PARTS };

struct job {
    struct run run;
    uint64_t most_steps; /* 0: to t_end */
    int processes;       /* that do the whole work simultaneously */
    bool keep; /* keep the last state for comparison; else memory is measured without it */
    struct run_result last;
    double peak_rss; /* after the first call */
};

static bool go_on(void *context, double time, uint64_t steps)
{
    const struct job *job = context;
    (void)time;
    return job->most_steps == 0 || steps < job->most_steps;
}

static enum status work(void *context, uint64_t times, struct clock_taken *taken,
                        struct error *error)
{
    struct job *job = context;
    job->run.asked.progress = go_on;
    job->run.asked.progress_context = job;
    for (uint64_t i = 0; i < times; i++) {
        run_free(&job->last);
        const enum status status = run_execute(&job->run, &job->last, error);
        if (status == STATUS_BROKE_DOWN || (!status && !job->keep)) run_free(&job->last);
        if (status) return status;
        taken->wall_s += job->last.cost.wall_s;
        taken->cpu_s += job->last.cost.cpu_s;
        if (!(job->peak_rss > 0)) job->peak_rss = job->last.peak_rss;
    }
    return STATUS_OK;
}

/* Runs the work of one thread in several processes at once, which share only the machine: their
 * gain is the limit for threads that never wait. Ends with the last process. */
static enum status work_at_once(void *context, uint64_t times, struct clock_taken *taken,
                                struct error *error)
{
    const struct job *job = context;
    struct clock_taken own = {0};
    const double began = clock_wall();
    int children = 0;
    for (; children < job->processes - 1; children++) {
        const pid_t child = fork();
        if (child < 0) break;
        if (child == 0) _exit((int)work(context, times, &own, error));
    }
    enum status status = STATUS_OK;
    if (children < job->processes - 1)
        status = error_set(error, STATUS_ENVIRONMENT, "no process: %s", strerror(errno));
    if (!status) status = work(context, times, &own, error);
    for (; children; children--) {
        int ended;
        while (wait(&ended) < 0 && errno == EINTR) continue;
        if (!status && ended)
            status = error_set(error, STATUS_ENVIRONMENT, "a process of the benchmark ended early");
    }
    taken->wall_s += clock_wall() - began;
    taken->cpu_s += own.cpu_s;
    return status;
}

/* Prepares a whole run or, with most_steps, steps in which no particle sleeps, and so short that
 * they do not reach t_end, beyond which a case may break down. */
static enum status prepare(struct job *job, const struct run_settings *settings, size_t n,
                           uint64_t most_steps, int threads, struct error *error)
{
    static char *const awake[] = {"skip=none", "cfl=1e-3"};
    char key[40], *keys[] = {key};
    struct run_settings asked = *settings;
    job->most_steps = most_steps;
    asked.threads = threads;
    asked.any_window = asked.any_window || most_steps;
    snprintf(key, sizeof key, "n=%zu", n);
    if (settings_apply(&asked.settings, 1, keys, error) ||
        (most_steps && settings_apply(&asked.settings, 2, awake, error)))
        return error->status;
    return run_resolve(&job->run, &asked, error);
}

struct bench {
    struct scaling *scaling;
    struct job
        *jobs; /* PARTS per level, then three per thread level: one thread, several, processes */
    struct bench_subject *subjects;
    size_t count;
};

static enum status add(struct bench *bench, size_t n, uint64_t most_steps, int threads,
                       int processes, struct error *error)
{
    struct job *job = &bench->jobs[bench->count];
    job->processes = processes;
    bench->subjects[bench->count++] =
        (struct bench_subject){.work = processes > 1 ? work_at_once : work, .context = job};
    return prepare(job, bench->scaling->settings, n, most_steps, threads, error);
}

static struct order_fit exponent(size_t n, const double *particles, const double *cost)
{
    double spacing[CASE_LADDER_MAX];
    struct order_fit fit = {0};
    struct error ignored;
    for (size_t i = 0; i < n; i++) spacing[i] = 1 / particles[i];
    if (n < ORDER_LEVELS_MIN || order_fit(n, spacing, cost, NULL, &fit, &ignored)) fit.n = 0;
    return fit;
}

static void fit(struct scaling *scaling)
{
    double n[CASE_LADDER_MAX], step[CASE_LADDER_MAX], run[CASE_LADDER_MAX], rss[CASE_LADDER_MAX],
        error[CASE_LADDER_MAX], c0, c[3], chi2;
    bool front[CASE_LADDER_MAX];
    size_t runs = 0;
    const size_t count = scaling->level_count, last = count < 3 ? 0 : count - 3;
    for (size_t i = 0; i < count; i++) {
        const struct scaling_level *level = &scaling->levels[i];
        n[i] = (double)level->n;
        step[i] = level->step_cpu_s;
        rss[i] = level->peak_rss;
        run[i] = level->run_cpu_s;
        error[i] = level->error;
        runs += isfinite(run[i]) ? 1u : 0u;
    }
    scaling->step = exponent(count, n, step);
    scaling->run = exponent(runs, n, run);
    precision_front(runs, run, error, front);
    for (size_t i = 0; i < runs; i++) scaling->levels[i].on_front = front[i];
    scaling->bytes_per_particle = (double)NAN;
    if (count >= 2)
        gsl_fit_linear(n + last, 1, rss + last, 1, count - last, &c0, &scaling->bytes_per_particle,
                       &c[0], &c[1], &c[2], &chi2);
}

static void read_level(struct bench *bench, size_t i, size_t first)
{
    struct scaling_level *level = &bench->scaling->levels[i];
    const struct bench_subject *parts = &bench->subjects[first];
    const struct job *jobs = &bench->jobs[first];
    const double brief = parts[PART_SHORT].time.cpu_s, longer = parts[PART_LONG].time.cpu_s;
    level->n = jobs[PART_LONG].last.n;
    const double step = (longer - brief) / (STEPS_LONG - STEPS_SHORT);
    level->step_cpu_s = step > 0 ? step : (double)NAN; /* lost in the machine's noise */
    level->set_up_cpu_s = fmax(brief - STEPS_SHORT * step, 0);
    level->spread = fmax(parts[PART_SHORT].time.spread, parts[PART_LONG].time.spread);
    level->peak_rss = jobs[PART_LONG].peak_rss;
    level->run_cpu_s = level->error = (double)NAN;
    if (level->n > RUN_N_MAX) return;
    const struct run_result *run = &jobs[PART_RUN].last;
    level->run_cpu_s = parts[PART_RUN].time.cpu_s;
    level->run_wall_s = parts[PART_RUN].time.wall_s;
    level->run_pairs = (double)run->cost.pair_interactions;
    level->run_steps = run->cost.steps;
    level->error = run->errors[FIELD_DENSITY].l1;
    level->settings = run->settings;
}

static void read_threads(struct bench *bench, size_t i, size_t first, int threads)
{
    const struct bench_subject *one = &bench->subjects[first], *more = one + 1, *apart = one + 2;
    const struct run_result *last = &bench->jobs[first].last,
                            *with_more = &bench->jobs[first + 1].last;
    bench->scaling->threads[i] = (struct scaling_threads){
        .n = last->n,
        .threads = threads,
        .wall_s = more->time.wall_s / STEPS_THREADS,
        .gain = one->time.wall_s / more->time.wall_s,
        .gain_of_processes = threads * one->time.wall_s / apart->time.wall_s,
        .same_bits = !(bench_skips_difference(&last->snapshot, &with_more->snapshot,
                                              domain_length(&last->problem.domain, 0)) > 0)};
}

enum status bench_scaling_measure(const struct run_settings *settings, const size_t *ladder,
                                  size_t count, int threads, const struct bench_rules *rules,
                                  struct scaling *scaling, struct error *error)
{
    *scaling = (struct scaling){.settings = settings, .level_count = count};
    const size_t most = PARTS * count + 3 * THREAD_LEVELS;
    size_t first[CASE_LADDER_MAX + THREAD_LEVELS];
    struct bench bench = {.scaling = scaling,
                          .jobs = calloc(most, sizeof *bench.jobs),
                          .subjects = calloc(most, sizeof *bench.subjects)};
    enum status status = STATUS_OK;
    if (!bench.jobs || !bench.subjects) status = error_set(error, STATUS_ENVIRONMENT, "no memory");
    for (size_t i = 0; i < count && !status; i++) {
        first[i] = bench.count;
        status = add(&bench, ladder[i], STEPS_SHORT, 1, 1, error);
        if (!status) status = add(&bench, ladder[i], STEPS_LONG, 1, 1, error);
        if (!status && ladder[i] <= RUN_N_MAX) status = add(&bench, ladder[i], 0, 1, 1, error);
    }
    for (size_t t = 0; t < THREAD_LEVELS && count && !status; t++) {
        if (thread_n[t] < ladder[0] || thread_n[t] > ladder[count - 1]) continue;
        first[count + scaling->thread_count++] = bench.count;
        for (int k = 0; k < 3 && !status; k++) {
            status = add(&bench, thread_n[t], STEPS_THREADS, k == 1 ? threads : 1,
                         k == 2 ? threads : 1, error);
            bench.jobs[bench.count - 1].keep = k < 2;
        }
    }
    if (!status) status = bench_measure(bench.subjects, bench.count, rules, error);
    for (size_t k = 0; k < bench.count && !status; k++)
        if (bench.subjects[k].failure.status) {
            *error = bench.subjects[k].failure;
            status = error->status;
        }
    for (size_t i = 0; i < count && !status; i++) read_level(&bench, i, first[i]);
    for (size_t i = 0; i < scaling->thread_count && !status; i++)
        read_threads(&bench, i, first[count + i], threads);
    if (!status) fit(scaling);
    for (size_t k = 0; k < bench.count; k++) run_free(&bench.jobs[k].last);
    free(bench.jobs), free(bench.subjects);
    return status;
}
