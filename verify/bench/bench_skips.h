/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures what each kind of skipped work saves, and whether results are the same without it. If a
 * key restores the work, both runs are made and compared. Passes that the plan leaves out because
 * nothing reads their results are timed separately. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "bench_possible.h"
#include "run.h"
#include "table.h"

/* The promise about results with and without the skipped work. */
#define BENCH_PROMISE_LIST(PROMISE)                                                                \
    PROMISE(BITS, "same bits")                                                                     \
    PROMISE(ROUND_OFF, "same to round-off")   /* largest difference of a field, relative */        \
    PROMISE(ERROR, "no larger error")         /* error without the work over error with it, - 1 */ \
    PROMISE(UNUSED, "result would be unused") /* nothing to compare */

enum bench_promise {
#define PROMISE(name, text) PROMISE_##name,
    BENCH_PROMISE_LIST(PROMISE)
#undef PROMISE
};

/* Runs without and with the work. */
enum bench_side { BENCH_WITHOUT, BENCH_WITH, BENCH_SIDES };

struct bench_skip {
    size_t case_index;
    const char *name; /* of the skipped work */
    const char *keys; /* keys that restore it, or the pass by itself */
    enum bench_promise promise;
    double bound; /* of the difference; 0 for bits; for round-off wider if the case amplifies it */
    double difference;         /* as the promise defines it; NaN: nothing to compare */
    const char *measured;      /* quantity of the error; NULL: no exact solution */
    double error[BENCH_SIDES]; /* L1 of density, else of velocity, else of the first functional */
    double momentum[BENCH_SIDES], energy[BENCH_SIDES]; /* conservation errors, as in a run */
    double cpu_s[BENCH_SIDES];   /* of a run, or of the update of one particle */
    double spread;               /* of the times, the larger one */
    struct bench_shares *shares; /* see bench_possible.h; NULL: none */
    /* fractions of the neighbour sums that omitted these terms; NaN: unknown */
    double without_viscosity, without_slope;
    bool kept;   /* the promise holds */
    bool enough; /* enough of the allowed work is skipped */
};

struct bench_skips {
    size_t case_count, count;
    struct run_settings *cases;
    size_t *n; /* particles, of each case */
    struct bench_skip *skips;
};

/* Kinds of skipped work: all, only particles that no signal has reached, only steps shorter than a
 * particle's own. */
enum bench_part { BENCH_WORK, BENCH_SLEEP, BENCH_STEPS };

/* cases: count prepared settings, copied; a case without such work has no entry. Returns STATUS_OK
 * even if a promise is broken or too little is skipped: see bench_skips_pass. Call bench_skips_free
 * even after a failure. */
enum status bench_skips_measure(const struct run_settings *cases, size_t count,
                                const struct bench_rules *rules, enum bench_part part,
                                struct bench_skips *result, struct error *error);
void bench_skips_free(struct bench_skips *result);

/* True if all promises hold and enough of the allowed work is skipped. */
bool bench_skips_pass(const struct bench_skips *result);

/* Array "skips" of a result document; maps: includes maps of sleeping gas. */
void bench_skips_add_json(const struct bench_skips *result, bool maps, json_t *document);
void bench_skips_print(const struct bench_skips *result, const struct table_style *style);
/* Prints results of BENCH_STEPS: local and global steps side by side. */
void bench_steps_print(const struct bench_skips *result, const struct table_style *style);

/* Largest difference of two snapshots in any field, relative to the field's largest value,
 * positions modulo the period; 0 only for equal bits. INFINITY: not comparable. */
double bench_skips_difference(const struct snapshot *a, const struct snapshot *b, double period);
