/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <stdbool.h>
#include <stdlib.h>

const struct bench_rules bench_usual = {.least_s = 0.02, .most_s = 5, .samples = 5};

enum { DOUBLINGS_MAX = 30 };

struct samples {
    double wall_s[BENCH_SAMPLES_MAX], cpu_s[BENCH_SAMPLES_MAX], total;
};

static void keep(struct bench_subject *subject, struct samples *samples,
                 const struct clock_taken *taken)
{
    const double times = (double)subject->time.times;
    samples->wall_s[subject->time.samples] = taken->wall_s / times;
    samples->cpu_s[subject->time.samples++] = taken->cpu_s / times;
    samples->total += taken->cpu_s;
}

static enum status fail(struct bench_subject *subject, struct error *error)
{
    if (subject->failure.status == STATUS_BROKE_DOWN) return STATUS_OK;
    *error = subject->failure;
    return error->status;
}

/* The first call warms up caches, pages and clocks and is discarded, unless it is so long that the
 * warm-up does not matter. The last doubling is the first sample. */
static enum status calibrate(struct bench_subject *subject, const struct bench_rules *rules,
                             struct samples *samples, struct error *error)
{
    struct clock_taken taken = {0};
    subject->failure = (struct error){0};
    subject->time = (struct bench_time){.times = 1};
    if (subject->work(subject->context, 1, &taken, &subject->failure)) return fail(subject, error);
    bool warm = taken.cpu_s > 20 * rules->least_s;
    for (int doubling = 0; !warm || taken.cpu_s < rules->least_s; doubling++) {
        if (warm) subject->time.times *= 2;
        warm = true;
        taken = (struct clock_taken){0};
        if (subject->work(subject->context, subject->time.times, &taken, &subject->failure))
            return fail(subject, error);
        if (doubling == DOUBLINGS_MAX) break;
    }
    keep(subject, samples, &taken);
    return STATUS_OK;
}

static bool enough(const struct bench_subject *subject, const struct bench_rules *rules,
                   const struct samples *samples)
{
    const int taken = subject->time.samples;
    return subject->failure.status || taken >= rules->samples ||
           (taken >= 2 && samples->total > rules->most_s);
}

static void finish(struct bench_subject *subject, struct samples *samples)
{
    struct bench_time *time = &subject->time;
    if (subject->failure.status) return;
    const size_t n = (size_t)time->samples;
    gsl_sort(samples->cpu_s, 1, n);
    gsl_sort(samples->wall_s, 1, n);
    time->cpu_s = samples->cpu_s[0];
    time->wall_s = samples->wall_s[0];
    time->spread = gsl_stats_median_from_sorted_data(samples->cpu_s, 1, n) / time->cpu_s - 1;
}

enum status bench_measure(struct bench_subject *subjects, size_t count,
                          const struct bench_rules *rules, struct error *error)
{
    enum status status = STATUS_OK;
    struct samples *samples = calloc(count + 1, sizeof *samples);
    if (!samples) return error_set(error, STATUS_ENVIRONMENT, "no memory for samples");
    for (int round = 0; round < rules->samples; round++)
        for (size_t i = 0; i < count; i++) {
            struct bench_subject *subject = &subjects[i];
            struct clock_taken taken = {0};
            if (round == 0) {
                status = calibrate(subject, rules, &samples[i], error);
            } else if (!enough(subject, rules, &samples[i])) {
                if (subject->work(subject->context, subject->time.times, &taken, &subject->failure))
                    status = fail(subject, error);
                else
                    keep(subject, &samples[i], &taken);
            }
            if (status) goto end;
            /* calibration costs about two more samples */
            const double done = (double)i + 1, all = (double)count;
            if (rules->progress)
                progress_update(rules->progress, round == 0 ? 3 * done : (2 + round) * all + done,
                                (2 + rules->samples) * all);
        }
    for (size_t i = 0; i < count; i++) finish(&subjects[i], &samples[i]);
end:
    free(samples);
    return status;
}
