/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures bounds for a code's gates: runs each case several times, with starts that differ by 2
 * units in the last place, other seeds and other numbers of threads; then with each [fault] of the
 * code file. The largest change by the former runs is the floor. A bound lies between the floor and
 * the smallest change by a fault that is well above it; without such a fault there is no gate.
 *
 * For an error e0 with floor F (at least 1e-4 e0, as another compiler may change that much) and
 * smallest change A >= 9 F by a fault, the gate allows e0 - D to e0 + D, where D = sqrt(F A). The
 * lower bound is at least e0/2, and omitted if F > e0/6. The floor of a conserved quantity is its
 * size (at least 1e-14), and there is no lower bound. Without faults in the file D is 10 F. */
#pragma once

#include "code_run.h"
#include "study.h"

enum {
    CALIBRATE_RUNS_MAX = 16,
    CALIBRATE_GATES_MAX = FIELDS + PROBLEM_FUNCTIONALS_MAX + TRACE_FIGURES
};

/* BLIND: no fault exceeds the floor enough; FREE: the file has no faults. */
enum calibrate_sight { CALIBRATE_SEES, CALIBRATE_BLIND, CALIBRATE_FREE };
extern const char *const calibrate_sights[]; /* as results write them */

struct calibrate_gate {
    char name[64];       /* the key in the code file */
    double value;        /* of the first run */
    double spread;       /* largest change by the other runs; of a conserved quantity its size */
    double floor;        /* the same, but at least the allowance */
    double least, bound; /* NaN: blind; least 0: none */
    double low, high;    /* of the order, from the code file; NaN: none */
    bool order_lost;     /* the order of the code file is left out because some runs miss it */
    double change[CODE_FAULTS_MAX]; /* change of the value; INFINITY: not finite */
    bool sees[CODE_FAULTS_MAX];
    int smallest; /* the seen fault with the smallest change; -1: none */
    enum calibrate_sight sight;
};

struct calibrate_case {
    const struct code_case *of;
    struct code_case *faulty;        /* code->fault_count */
    struct code_external *externals; /* runs, then faults, like the studies */
    struct study *studies;
    size_t gate_count;
    struct calibrate_gate gates[CALIBRATE_GATES_MAX];
    bool breaks[CODE_FAULTS_MAX]; /* the fault leaves no result: seen without a gate */
    bool seen[CODE_FAULTS_MAX];
    char trouble[SUSPICION_TEXT]; /* why a report fails regardless of gates, or "" */
};

struct calibrate {
    const struct code *code;
    size_t runs, count;
    struct calibrate_case *cases;
};

/* Adds all runs to a pool. names: of cases of the code; count 0: all of them. STATUS_BAD_INPUT: no
 * such case, or one without a ladder. Call calibrate_free in any case; calibrate and code must not
 * move in memory before. */
enum status calibrate_plan(struct calibrate *calibrate, const struct code *code, size_t runs,
                           size_t count, char *const *names, struct pool *pool,
                           struct error *error);

/* After pool_run: finds the gates. STATUS_CHECK_FAILED: a fault is seen by no gate, or a report
 * would fail; STATUS_BROKE_DOWN: a run without a fault has no result. */
enum status calibrate_judge(struct calibrate *calibrate, const struct pool *pool,
                            struct error *error);

/* The code file with these gates instead of those of the same cases; malloced. STATUS_BAD_INPUT:
 * the file has changed. */
enum status calibrate_text(const struct calibrate *calibrate, char **text, struct error *error);

/* Adds "code", "runs" and "cases". */
void calibrate_add_json(const struct calibrate *calibrate, json_t *document);

void calibrate_free(struct calibrate *calibrate);
