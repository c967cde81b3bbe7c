/* SPDX-License-Identifier: GPL-3.0-or-later
 * Studies: any case, any combination of schemes, a ladder of resolutions, replicates of each: over
 * seeds where the initial state is random, else over numbers of particles within 2.5 % of the
 * level's. (Where a shock lies among the particles at the end changes from n to n: the error of
 * one n is a draw, with strong shocks from a distribution 14 % wide.) Every run is a job of a pool;
 * from the runs come orders with their 95 % interval, gates, functionals with Richardson
 * extrapolation and GCI, error budgets, and whatever looks too good to be true. */
#pragma once

#include <jansson.h>

#include "gates.h"
#include "order.h"
#include "pool.h"
#include "run.h"
#include "suspicion.h"
#include "sweep.h"

enum { STUDY_REPLICATES_MAX = 64 };

/* Parts of the velocity of a circular flow, see problem.h. */
enum study_part { STUDY_AZIMUTHAL, STUDY_RADIAL, STUDY_PARTS };
extern const char *const study_part_names[STUDY_PARTS];

/* Means over the replicates of one resolution; of errors and spacings the geometric mean. */
struct study_level {
    size_t n;          /* of the first replicate */
    size_t n_range[2]; /* of all */
    double spacing, h; /* box/n; mean smoothing length in the window: lengths */
    double errors[FIELDS][NORMS], binned_density_l1;
    double parts[STUDY_PARTS][NORMS]; /* NaN where the flow is not circular */
    /* Standard deviation of log(error) over the replicates, about a line of the ladder's slope
     * where they differ in n. */
    double spread[FIELDS][NORMS];
    double cpu_s;
    struct budget budget;
    double functionals[PROBLEM_FUNCTIONALS_MAX];
    double kept[TRACE_FIGURES]; /* what is conserved: of the worst replicate; NaN: not known */
};

struct study_order {
    struct order_fit fit;
    enum finding_status status;
    struct order_gate gate;    /* bound: at the ladder's finest level; see study_judge */
    double least;              /* of the error there, see cases.h; 0: none */
    char why[ORDER_GATE_TEXT]; /* the condition that fails; why it says little */
    const char *known;         /* why it is known to fail, "" if it is not; the case's */
};

/* One scheme over the ladder. */
struct study_result {
    enum status status;       /* OK, CHECK_FAILED (a gate, or suspicious), BROKE_DOWN */
    char message[512];        /* how it broke down; why the combination is excluded */
    bool excluded;            /* the scheme does not allow it: nothing was run */
    struct settings settings; /* resolved, at the finest level */
    struct scheme scheme;
    size_t level_count, functional_count; /* levels that are sound, from the coarsest on */
    struct study_level levels[CASE_LADDER_MAX];
    struct study_order orders[FIELDS][NORMS];
    struct order_fit regions[PROBLEM_REGIONS_MAX]; /* of L1(density); n = 0: not everywhere there */
    const char *functional_names[PROBLEM_FUNCTIONALS_MAX];
    double functional_exact[PROBLEM_FUNCTIONALS_MAX];
    struct order_extrapolation functionals[PROBLEM_FUNCTIONALS_MAX]; /* of the three finest */
    /* In 2D and 3D: of L1 of the parts, and of |functional - exact|; n = 0: there is none. */
    struct order_fit parts[STUDY_PARTS];
    struct study_order functional_errors[PROBLEM_FUNCTIONALS_MAX]; /* gate: of any order */
    struct study_order kept[TRACE_FIGURES]; /* of no order; fit: only `finest` and n, levels */
    double floor_density, floor_gradient;   /* lattice sums of kernel and eta, relative */
    bool floor_explains;                    /* a failed order is of the size of the floor */
    double still;                           /* largest of the levels' budgets; NaN: none */
    enum finding_status still_status;
    char suspicion[SUSPICION_TEXT]; /* "" if nothing is too good to be true */
    double interpolation[FIELDS];   /* of the run; NaN: the reference is no table of a user's */
};

/* Undisturbed gas may move at this part of the sound speed. */
#define STUDY_STILL_BOUND 1e-3

struct study {
    struct run_settings settings; /* n, seed and what varies are set for each run */
    struct sweep sweep;
    size_t ladder[CASE_LADDER_MAX], level_count; /* rising, at least ORDER_LEVELS_MIN */
    size_t replicates;                           /* of each level, >= 1: study_replicates */
    /* from study_plan and study_judge: */
    enum status status;             /* the worst of the results */
    struct study_result *results;   /* sweep.count */
    struct run *runs;               /* combination, level, replicate: the last runs fastest */
    size_t *jobs;                   /* their numbers in the pool */
    char suspicion[SUSPICION_TEXT]; /* a setting that changes nothing */
};

/* Adds the runs to the pool. STATUS_BAD_INPUT: settings that no run could have. The study must stay
 * where it is until study_free. */
enum status study_plan(struct study *study, struct pool *pool, struct error *error);

/* After pool_run: fills and judges the results. The gates are the case's; a bound belongs to the
 * case's own finest level and is raised as the least order allows where the ladder ends before it.
 * Anything but STATUS_OK means that runs are missing for reasons of the environment. */
enum status study_judge(struct study *study, const struct pool *pool, struct error *error);

void study_free(struct study *study);

/* Same errors at all levels to the last bit although `what` differs? See suspicion.h. */
bool study_suspect_same(const char *what, const struct study_result *a,
                        const struct study_result *b, char *why);

/* Is the initial state random, so that a seed makes a difference? */
bool study_is_random(const struct settings *settings);

/* How many replicates a case needs: 3 of a random start, 9 where the solution jumps (in 1D; in more
 * dimensions a lattice has few numbers of particles), 1 of what is smooth. */
size_t study_replicates(const struct run_settings *settings);

/* The number of particles of replicate r: the level's own, then in turns above and below, all of
 * them within 2.5 %; next neighbours where that is less than a particle each. */
size_t study_neighbour(size_t n, size_t replicates, size_t r);

/* Adds "dimension", "measured" (what the case is judged by, the first thing first), "levels",
 * "orders", "functionals", "floors", "budgets", "excluded", and "message" and "suspicion" where
 * there are any, to a converge document. */
void study_add_json(const struct study *study, json_t *document);

/* Those of combination c, in order, up to the first that broke down: result->status says so.
 * STATUS_ENVIRONMENT and others: a run is missing. */
enum status study_read_levels(struct study *study, size_t c, const struct pool *pool,
                              struct error *error);
