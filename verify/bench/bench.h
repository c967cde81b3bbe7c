/* SPDX-License-Identifier: GPL-3.0-or-later
 * Timing on a busy machine (after the benchmark library of FFTW). Each subject is warmed up, its
 * work is repeated until one sample takes a minimum time, and then samples of all subjects are
 * taken in turn, so that other load does not affect one alone. The result is the shortest sample;
 * the median shows how reliable it is. */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "clock.h"
#include "progress.h"
#include "status.h"

/* Does the work `times` times and adds the time of the work alone to *taken. */
typedef enum status bench_work(void *context, uint64_t times, struct clock_taken *taken,
                               struct error *error);

struct bench_time {
    double wall_s, cpu_s; /* of the work done once: the minimum over the samples */
    double spread;        /* median of the samples' cpu_s over the least one, minus 1 */
    uint64_t times;       /* repetitions of the work in a sample */
    int samples;
};

struct bench_subject {
    bench_work *work;
    void *context;
    struct bench_time time; /* result */
    struct error failure;   /* STATUS_OK, or why there is no result */
};

enum { BENCH_SAMPLES_MAX = 64 };
struct bench_rules {
    double least_s; /* least CPU time of a sample */
    double most_s;  /* greatest CPU time of a subject's samples; at least two are taken */
    int samples;    /* 1 .. BENCH_SAMPLES_MAX */
    struct progress *progress; /* in samples; NULL: none is shown */
};
extern const struct bench_rules bench_usual;

/* Measures all subjects. One that breaks down is left out, with the reason in its failure; any
 * other status ends the measurement and is returned. */
enum status bench_measure(struct bench_subject *subjects, size_t count,
                          const struct bench_rules *rules, struct error *error);
