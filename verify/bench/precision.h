/* SPDX-License-Identifier: GPL-3.0-or-later
 * Work-precision: what an error costs. Schemes (a sweep) x resolutions on one case, each timed as
 * bench.h says; the Pareto front; the cheapest way to a given error; L1^(2/p) x CPU time, which at
 * the case's order p does not depend on the resolution (work grows as n^2). For comparison the
 * corrected method of the seed program, by the solver and as plain C. The error is the L1 of
 * density, relative to the signal: how far the exact density is from its own mean.
 * In d dimensions errors fall as n^(-p/d) and work grows as n^((d+1)/d): L1^((d+1)/p) x CPU time;
 * the error is that of judged.h, and the comparison is with textbook SPH. */
#pragma once

#include <jansson.h>

#include "bench.h"
#include "pool.h"
#include "run.h"
#include "sweep.h"
#include "table.h"

enum { PRECISION_TARGETS = 3, PRECISION_SHORT = 96 };
extern const double precision_targets[PRECISION_TARGETS]; /* relative to the signal */

struct precision_point {
    size_t scheme, n;       /* n: as the lattice allowed */
    double error, relative; /* geometric mean over neighbouring n if the solution jumps */
    double error_spread;    /* standard deviation of its logarithm; NaN of a single n */
    double pairs;           /* pair interactions */
    bool on_front;
    struct settings settings; /* as used, resolved */
    struct bench_time time;
    const char *processor; /* that the time is of; NULL: all are of this one */
    struct error failure;
};

/* Additional curves: the seed program's method, by the solver and in plain C, for comparison and
 * never on the front; and the user's own keys with masses graded towards the jump instead of equal
 * ones, which compete like any other. */
enum precision_reference { REFERENCE_NONE, REFERENCE_GRADED, REFERENCE_SEED, REFERENCE_SEED_PLAIN };

struct precision_scheme {
    char label[SWEEP_LABEL]; /* "kernel=cubic_spline gradient=ia" */
    char brief[SWEEP_LABEL]; /* the values alone, for plots */
    enum precision_reference reference;
    size_t first, count; /* its points, n rising; 0 if it is excluded or broke down */
    double merit;        /* L1^(2/p) x CPU time at the finest n; NaN without points */
    double gain;         /* merit of the plain reference over this one's, same ladder */
    char excluded[512];  /* reason if there is no point */
};

struct precision_way {
    double error; /* L1 of density */
    double cpu_s; /* interpolated along a scheme's curve; NaN: not reached by any scheme */
    size_t scheme;
};

struct precision {
    const struct run_settings *settings;
    double mean_density, signal; /* exact, of the measure window at t_end: mean, and mean distance
                                    from it (or the mean where that is 0) */
    const char *error_of;        /* quantity of the error, static string */
    int dim;
    int order; /* of the case: of its gate on L1 of density; without one 1 in 1D, in 2D and 3D 2 of
                  what is smooth, else 1 */
    size_t scheme_count, point_count;
    struct precision_scheme *schemes; /* references last */
    struct precision_point *points;   /* by scheme, then n */
    struct precision_way cheapest[PRECISION_TARGETS];
    struct precision_work *work; /* the measurements; owned */
};

/* ladder: count rising numbers of particles. An external program in settings is one scheme, and the
 * others are ours. settings must outlive the result. Schemes that keys exclude, or that break down
 * at some n, are kept with the reason. STATUS_BAD_INPUT: no scheme is left. Call precision_free
 * even after a failure. */
enum status precision_measure(const struct run_settings *settings, const struct sweep *sweep,
                              const size_t *ladder, size_t count, const struct bench_rules *rules,
                              struct precision *precision, struct error *error);
void precision_free(struct precision *precision);

/* The same in two parts, for several machines: each n is a job of the pool that measures all
 * schemes in turn; after pool_run, precision_conclude judges them. Compares only times of one
 * processor. rules must outlive pool_run, the pool the result. */
enum status precision_plan(const struct run_settings *settings, const struct sweep *sweep,
                           const size_t *ladder, size_t count, const struct bench_rules *rules,
                           struct precision *precision, struct pool *pool, struct error *error);
enum status precision_conclude(struct precision *precision, const struct pool *pool,
                               struct error *error);

/* The t-th target, relative to the signal; ten times larger in 2D and 3D. */
double precision_target(const struct precision *precision, size_t t);

/* A run_solver: the seed program's corrected method in plain C (plain.h). STATUS_BAD_INPUT: an
 * unknown scheme. */
void precision_plain(const struct setup *setup, struct run_outcome *outcome);

/* --- the arithmetic, by itself ---------------------------------------------------------------- */

/* Judges existing points: fills the front, gains and cheapest ways. STATUS_ENVIRONMENT: no
 * memory. */
enum status precision_judge(struct precision *precision, struct error *error);

/* error^((d+1)/p) cpu_s: independent of resolution at the case's order p. */
double precision_merit(const struct precision *precision, double error, double cpu_s);

/* True if the scheme competes for the front and for the cheapest way. */
bool precision_competes(const struct precision_scheme *scheme);

/* A finite point is on the front if no other point is at most as expensive, at most as inaccurate,
 * and better in one of both. */
void precision_front(size_t n, const double *cost, const double *error, bool *on_front);

/* Least cost at which a curve (points in order of resolution) reaches an error: interpolated
 * log-log between neighbouring points, never extrapolated; the first point's cost if its error is
 * small enough. NaN: not reached. */
double precision_cost_of(size_t n, const double *cost, const double *error, double target);

/* Prints schemes by figure of merit, the front and the cheapest ways. */
void precision_print(const struct precision *precision, const struct table_style *style);

/* Error against CPU time, curves named at their ends: both references and the schemes with points
 * on the front, as many as there are colours; all others as points. STATUS_ENVIRONMENT. */
enum status precision_plot(const struct precision *precision, const char *path,
                           struct error *error);

/* "case", "points", "schemes", "cheapest", "excluded" ... of a result document. */
void precision_add_json(const struct precision *precision, json_t *document);
