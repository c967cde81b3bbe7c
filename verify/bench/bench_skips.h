/* SPDX-License-Identifier: GPL-3.0-or-later
 * What each piece of work that a run leaves out would cost, and whether the answer is the same
 * without it. Some can be switched on by a key: both runs are made and compared. Others are passes
 * that the plan does not contain and nothing would read: these are timed by themselves. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "bench_possible.h"
#include "run.h"
#include "table.h"

/* What is promised about the answer with and without the work. */
#define BENCH_PROMISE_LIST(PROMISE)                                                                \
    PROMISE(BITS, "same bits")                                                                     \
    PROMISE(ROUND_OFF, "same to round-off")   /* largest difference of a field, relative */        \
    PROMISE(ERROR, "no larger error")         /* without the work over that with it, - 1 */        \
    PROMISE(UNUSED, "result would be unused") /* nothing to compare */

enum bench_promise {
#define PROMISE(name, text) PROMISE_##name,
    BENCH_PROMISE_LIST(PROMISE)
#undef PROMISE
};

/* With the work left out, and with it done. */
enum bench_side { BENCH_WITHOUT, BENCH_WITH, BENCH_SIDES };

struct bench_skip {
    size_t case_index;
    const char *name; /* of the work left out */
    const char *keys; /* that bring it back, or the pass by itself */
    enum bench_promise promise;
    double bound; /* of the difference; 0 for bits; round-off: wider where the case amplifies it */
    double difference;    /* as the promise defines it; NaN where there is nothing to compare */
    const char *measured; /* what the error is of; NULL: nothing is exact */
    double error[BENCH_SIDES]; /* L1 of density; else of velocity, else of the first functional */
    double momentum[BENCH_SIDES], energy[BENCH_SIDES]; /* how far not conserved, as of a run */
    double cpu_s[BENCH_SIDES];                         /* of a run, or of a particle's update */
    double spread;                                     /* the larger of both */
    struct bench_shares *shares; /* which and how many: bench_possible.h; NULL: no such thing */
    /* fractions of the sums over neighbours from which these were left out; NaN: not known */
    double without_viscosity, without_slope;
    bool kept;   /* the promise */
    bool enough; /* is skipped of what is allowed */
};

struct bench_skips {
    size_t case_count, count;
    struct run_settings *cases;
    size_t *n; /* particles, of each case */
    struct bench_skip *skips;
};

/* Of what can be left out: everything, only particles that no signal has reached, only steps that
 * are shorter than a particle's own. */
enum bench_part { BENCH_WORK, BENCH_SLEEP, BENCH_STEPS };

/* cases: count prepared settings, copied; those without such work have no entry. STATUS_OK also
 * where a promise is broken or too little skipped: see kept and enough. Free with bench_skips_free,
 * also after a failure. */
enum status bench_skips_measure(const struct run_settings *cases, size_t count,
                                const struct bench_rules *rules, enum bench_part part,
                                struct bench_skips *result, struct error *error);
void bench_skips_free(struct bench_skips *result);

/* Array "skips" of a result document; maps: with where and when gas sleeps. */
void bench_skips_add_json(const struct bench_skips *result, bool maps, json_t *document);
void bench_skips_print(const struct bench_skips *result, const struct table_style *style);
/* The same of BENCH_STEPS: local and global steps side by side. */
void bench_steps_print(const struct bench_skips *result, const struct table_style *style);

/* Largest difference of two snapshots in any field, relative to the field's largest value,
 * positions to the period; 0 only for the same bits. INFINITY: not comparable. */
double bench_skips_difference(const struct snapshot *a, const struct snapshot *b, double period);
