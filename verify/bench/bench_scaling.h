/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures how the cost of a step and of a run, and memory, grow with n, and the speed-up by
 * threads. Exponents are least-squares slopes in log-log with their 95 % interval. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "order.h"
#include "run.h"
#include "table.h"

enum { SCALING_THREADS_MAX = 8 };

struct scaling_level {
    size_t n;
    double step_cpu_s, set_up_cpu_s; /* one step with all particles active; everything before the
                                        first step; NaN: lost in noise */
    double spread;
    double peak_rss;  /* bytes of the process after this level (non-decreasing) */
    double run_cpu_s; /* whole run as given; NaN if it would take too long */
    double run_wall_s, run_pairs, error; /* of the whole run; error: L1 of density */
    bool on_front;
    uint64_t run_steps;
    struct settings settings; /* of the whole run, resolved */
};

struct scaling_threads {
    size_t n;
    int threads;
    double wall_s, gain;      /* of a step with its share of the set-up; speed-up over one thread */
    double gain_of_processes; /* the same for as many simultaneous runs of one thread */
    bool same_bits;
};

struct scaling {
    const struct run_settings *settings;
    size_t level_count, thread_count;
    struct scaling_level levels[CASE_LADDER_MAX];
    struct scaling_threads threads[SCALING_THREADS_MAX];
    struct order_fit step, run; /* exponent = -order: spacing is 1/n. n = 0: too few levels */
    double bytes_per_particle;  /* slope of peak_rss, three largest levels; NaN: fewer than two */
};

/* ladder: count rising numbers of particles; threads: compared with one, >= 2. settings must live
 * as long as the result. */
enum status bench_scaling_measure(const struct run_settings *settings, const size_t *ladder,
                                  size_t count, int threads, const struct bench_rules *rules,
                                  struct scaling *scaling, struct error *error);

/* "points" (the whole runs) and "scaling" of a result document. */
void bench_scaling_add_json(const struct scaling *scaling, json_t *document);
void bench_scaling_print(const struct scaling *scaling, const struct table_style *style);
enum status bench_scaling_plot(const struct scaling *scaling, const char *path,
                               struct error *error);
