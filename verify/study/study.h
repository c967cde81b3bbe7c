/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies: any case, any combination of schemes, a ladder of resolutions, replicates of each: with
 * other seeds if the initial state is random, else with numbers of particles near the level's. (The
 * position of a shock between the particles changes with n, so that the error at one n is a random
 * draw, for strong shocks with a scatter of 14 %.) Every run is a job of a pool; from the runs come
 * orders with their 95 % interval, gates, functionals with Richardson extrapolation and GCI, error
 * budgets, and warnings of results that are too good to be true. */
#pragma once

#include <jansson.h>

#include "gates.h"
#include "order.h"
#include "pool.h"
#include "run.h"
#include "suspicion.h"
#include "sweep.h"

enum { STUDY_REPLICATES_MAX = 64 };

/* Velocity components of a circular flow, see problem.h. */
enum study_part { STUDY_AZIMUTHAL, STUDY_RADIAL, STUDY_PARTS };
extern const char *const study_part_names[STUDY_PARTS];

/* Means over the replicates of one resolution: geometric for errors and spacings. */
struct study_level {
    size_t n;          /* of the first replicate */
    size_t n_range[2]; /* of all */
    double spacing, h; /* box/n; mean smoothing length in the window */
    double errors[FIELDS][NORMS], binned_density_l1;
    double parts[STUDY_PARTS][NORMS]; /* NaN if the flow is not circular */
    /* Standard deviation of log(error) over the replicates, about a line with the ladder's slope if
     * their n differ. */
    double spread[FIELDS][NORMS];
    double cpu_s;
    struct budget budget;
    double functionals[PROBLEM_FUNCTIONALS_MAX];
    double kept[TRACE_FIGURES]; /* conservation errors of the worst replicate; NaN: unknown */
};

struct study_order {
    struct order_fit fit;
    enum finding_status status;
    struct order_gate gate;    /* bound: at the ladder's finest level, see study_judge */
    double least;              /* least error there, see cases.h; 0: none */
    char why[ORDER_GATE_TEXT]; /* the failed condition, or why the result says little */
    const char *known;         /* reason of a known failure, else ""; owned by the case */
};

/* One scheme over the ladder. */
struct study_result {
    enum status status; /* OK, CHECK_FAILED (a gate fails, or results are suspicious), BROKE_DOWN */
    char message[512];  /* reason of a breakdown or an exclusion */
    bool excluded;      /* not allowed by the scheme; nothing was run */
    struct settings settings; /* resolved, at the finest level */
    struct scheme scheme;
    size_t level_count, functional_count; /* sound levels, coarsest first */
    struct study_level levels[CASE_LADDER_MAX];
    struct study_order orders[FIELDS][NORMS];
    struct order_fit regions[PROBLEM_REGIONS_MAX]; /* of L1(density); n = 0: missing at a level */
    const char *functional_names[PROBLEM_FUNCTIONALS_MAX];
    double functional_exact[PROBLEM_FUNCTIONALS_MAX];
    struct order_extrapolation
        functionals[PROBLEM_FUNCTIONALS_MAX]; /* from the three finest levels */
    /* In 2D and 3D: of L1 of the components, and of |functional - exact|; n = 0: none. */
    struct order_fit parts[STUDY_PARTS];
    struct study_order functional_errors[PROBLEM_FUNCTIONALS_MAX]; /* the gate accepts any order */
    struct study_order kept[TRACE_FIGURES]; /* without an order; fit: only `finest`, n and levels */
    double floor_density, floor_gradient;   /* relative errors of the lattice sums */
    bool floor_explains;                    /* the floor explains a failed order */
    double still;                           /* largest of the levels; NaN: none */
    enum finding_status still_status;
    char suspicion[SUSPICION_TEXT]; /* "" if nothing is too good to be true */
    double interpolation[FIELDS];   /* of a user's reference table; NaN: there is no table */
};

/* Undisturbed gas may move at this fraction of the sound speed. */
#define STUDY_STILL_BOUND 1e-3

struct study {
    struct run_settings settings; /* n, seed and varied keys are set for each run */
    struct sweep sweep;
    size_t ladder[CASE_LADDER_MAX], level_count; /* rising; at least ORDER_LEVELS_MIN levels */
    size_t replicates;                           /* of each level, >= 1: study_replicates */
    /* set by study_plan and study_judge: */
    enum status status;           /* the worst of the results */
    struct study_result *results; /* sweep.count */
    struct run *runs;             /* combination, level, replicate; the last index varies fastest */
    size_t *jobs;                 /* their indices in the pool */
    char suspicion[SUSPICION_TEXT]; /* a setting without effect */
};

/* Adds the runs to the pool. STATUS_BAD_INPUT: settings that no run can have. The study must not
 * move in memory before study_free. */
enum status study_plan(struct study *study, struct pool *pool, struct error *error);

/* After pool_run: fills and judges the results. The gates are the case's; a bound belongs to the
 * case's finest level and is raised by the least order if the ladder ends below it. Any status but
 * STATUS_OK means that runs are missing because the environment failed. */
enum status study_judge(struct study *study, const struct pool *pool, struct error *error);

void study_free(struct study *study);

/* True if the errors at all levels are bitwise equal although `what` differs, see suspicion.h. */
bool study_suspect_same(const char *what, const struct study_result *a,
                        const struct study_result *b, char *why);

/* Number of replicates of a case: 3 for a random start, 9 for solutions with jumps in 1D, else 1.
 * With the small default jitter of lattice=jittered in 2D and 3D, where runs are expensive, 1. */
size_t study_replicates(const struct run_settings *settings);

/* Number of particles of replicate r: the level's own, then alternately above and below it (very
 * small n: only above): in 1D within 2.5 %, but at least `least` apart; in 2D and 3D those of a
 * lattice with one row more, one less, two more ... along each side. */
size_t study_neighbour(size_t n, int dim, size_t replicates, size_t least, size_t r);

/* Adds "dimension", "measured" (the figures that judge the case, the most important first),
 * "levels", "orders", "functionals", "floors", "budgets", "excluded", and, if there are any,
 * "message" and "suspicion" to a converge document. */
void study_add_json(const struct study *study, json_t *document);

/* Reads the levels of combination c, in order, up to the first breakdown, which result->status
 * reports. STATUS_ENVIRONMENT and others: a run is missing. */
enum status study_read_levels(struct study *study, size_t c, const struct pool *pool,
                              struct error *error);
