/* SPDX-License-Identifier: GPL-3.0-or-later
 * One run, from the settings to the result: the settings are resolved once, the particles are made,
 * the simulation runs, and errors, conservation and cost are measured. The commands run, converge,
 * bench, report and stress compute everything this way. */
#pragma once

#include <jansson.h>

#include "cases.h"
#include "checkpoint.h"
#include "description.h"
#include "estimate.h"
#include "growth.h"
#include "norm.h"
#include "problem.h"
#include "regularity.h"
#include "relax.h"
#include "snapshots.h"
#include "settings.h"
#include "simulation.h"
#include "suspicion.h"
#include "trace.h"

enum { RUN_PLAN_MAX = 32 };

/* The result of a solver. */
struct run_outcome {
    enum status status; /* of the run */
    struct error reason;
    struct conservation start, end;
    struct simulation_cost cost;
    struct snapshot snapshot;     /* the arrays belong to the solver until `release` */
    void *owned;                  /* memory of the solver */
    void (*release)(void *owned); /* frees `owned`; may be NULL */
};

/* A solver other than the core: runs a setup to its t_end. It leaves a snapshot only if the status
 * is STATUS_OK or STATUS_BROKE_DOWN. */
typedef void run_solver(const struct setup *setup, struct run_outcome *outcome);

struct run;

/* An external program that computes runs. Its implementation extends this struct, which must be the
 * first member. */
struct run_external {
    const char *title;
    /* Adds to the cache key everything that decides the result beside the case and its keys.
     * STATUS_BAD_INPUT: a key that the program does not support. */
    enum status (*add_key)(const struct run_external *external, const struct run *run, json_t *key,
                           struct error *error);
    /* Creates the document of `sphproof run`, with the profile if asked. STATUS_BROKE_DOWN: the run
     * failed, as the document says. */
    enum status (*compute)(const struct run_external *external, const struct run *run, bool profile,
                           json_t **document, struct error *error);
    /* Adds "code", the description of the program, to the document of many runs. */
    void (*describe)(const struct run_external *external, json_t *document);
};

struct run_settings {
    struct case_file file;
    struct settings settings; /* of the case, overridden by the user; may still be `auto` */
    int threads;              /* >= 1 */
    bool any_window;          /* also run where waves from the mirrored tube reach the window */
    bool generic;             /* use the generic loops, not the specialised ones */
    int layers;               /* for run_start: layers made of a 2D problem; 0: none */
    bool equal_masses;        /* for run_start: require particles of equal masses */
    run_solver *solver;       /* NULL: the core solver */
    const struct run_external *external; /* computes the document; NULL: this program */
    simulation_progress *progress;       /* called every 32 steps; may be NULL */
    void *progress_context;
    bool each_step;                /* call progress after every step, since steps may be long */
    struct checkpoint *checkpoint; /* where the state of the run is saved; NULL: nowhere */
    struct snapshots *snapshots;   /* intermediate snapshots; NULL: none */
    struct trace *trace; /* starts as {0} and receives the time series; NULL: none is kept */
};

/* A run with every choice made: no `auto` is left, and the exact solution is known. The cache key,
 * the plan and the result are derived from this struct. Call run_resolve again after changing a
 * key; the other members of `asked` (threads, progress, trace ...) may still be changed. */
struct run {
    struct run_settings asked;
    struct settings settings;
    struct scheme scheme;
    struct prepared problem;
};

/* A scalar of the final state, for extrapolation where no exact value is known. */
struct run_functional {
    const char *name;
    double value, exact;
};

/* Numerical half-width of a wave in units of the smoothing length. */
#define BUDGET_REACH 3.

/* Error budget: the L1 norm split by the regions of the problem (problem.h), and a check that gas
 * not yet reached by a wave is unchanged. */
struct budget {
    const struct regions *regions; /* NULL: the problem has none */
    /* the sum over regions is the L1 norm; 0 for a region outside the window */
    double l1[PROBLEM_REGIONS_MAX][FIELDS];
    double still; /* max |v - v0|/c in undisturbed gas of the whole box; NaN: too few particles */
};

struct run_result {
    enum status status;       /* STATUS_OK or STATUS_BROKE_DOWN */
    char message[512];        /* why it broke down */
    char case_name[256];      /* as given to case_load; "" if there is no case */
    struct settings settings; /* resolved; settings, scheme and problem are copies of the run's */
    struct scheme scheme;
    struct prepared problem;
    size_t n;
    double time;
    struct norms errors[FIELDS];    /* at `time`; NaN if no particle is in the window; the velocity
                                       error in 2D and 3D is |v - exact| */
    struct norms azimuthal, radial; /* velocity errors of a circular flow */
    double binned_density_l1;       /* 1D only */
    double interpolation[FIELDS]; /* error of a user's table (user_solution_error); NaN: no table */
    struct regularity regularity; /* of the final state, with the scheme's kernel */
    struct estimate estimate;     /* made before the run */
    struct regularity start;      /* of a glass (relax_measure); density NaN: it is no glass */
    size_t crossed;               /* 1D: pairs of initial neighbours that are no longer adjacent */
    double spacing, h;    /* (box/n)^(1/d); volume-weighted mean smoothing length in the window */
    struct budget budget; /* L1 by regions of the problem */
    struct trace_drift drift;   /* at `time`; momentum only along directions without walls, layers
                                   or gravity */
    struct trace_motion motion; /* NaN: unknown */
    struct simulation_cost cost;
    struct description_sums matrix; /* at `time`; none after a breakdown */
    double peak_rss;                /* bytes; peak of the process so far */
    struct plan_line plan[RUN_PLAN_MAX];
    size_t plan_count;
    char warnings[512];
    char suspicion[SUSPICION_TEXT]; /* "" unless the errors look implausible */
    struct run_functional functionals[PROBLEM_FUNCTIONALS_MAX];
    size_t functional_count;
    struct growth growth;     /* for a problem with a growing amplitude */
    struct snapshot snapshot; /* owned by the result; freed by run_free */
    double *storage;
};

/* Loads a case and applies KEY=VALUE arguments. */
enum status run_prepare(struct run_settings *settings, const char *case_name, int n,
                        char *const *arguments, struct error *error);

/* STATUS_BAD_INPUT: the keys contradict each other, or no problem or scheme can be made from
 * them. */
enum status run_resolve(struct run *run, const struct run_settings *asked, struct error *error);

/* The solver's input; initial: the initial state of the run's problem. */
struct setup run_setup(const struct run *run, const struct initial *initial);

/* Runs the simulation and measures the result. STATUS_OK and STATUS_BROKE_DOWN leave a result,
 * which the caller frees with run_free; no other status does. STATUS_BAD_INPUT: the exact solution
 * does not hold in the window up to t_end, or the problem is a liquid. */
enum status run_execute(const struct run *run, struct run_result *result, struct error *error);

/* Everything except the simulation: fills plan, estimate, warnings and the expected n. Returns as
 * run_execute, and STATUS_ENVIRONMENT if there is not enough memory. */
enum status run_explain(const struct run *run, struct run_result *result, struct error *error);

/* The state at t = 0 of the particles that run_execute starts from, with the density and smoothing
 * length computed by the solver. Takes no step and measures nothing. With asked.layers the state is
 * in 3D (see slab.h), and only box, boundary and gamma of the result's problem are valid. Returns
 * as run_execute, but leaves a result only with STATUS_OK. */
enum status run_start(const struct run *run, struct run_result *result, struct error *error);

/* Sets asked->equal_masses and the problem's keys for particles of equal masses. */
enum status run_ask_equal_masses(struct run_settings *asked, struct error *error);

/* Measures errors and functionals of a state that another code has computed. The run's t_end is the
 * time of the state. 1D: sorted by position; id: 0 ... n - 1. STATUS_BAD_INPUT: the exact solution
 * does not hold in the window. */
enum status run_judge(const struct run *run, const struct snapshot *snapshot,
                      struct run_result *result, struct error *error);
void run_free(struct run_result *result);

/* "errors" of a result document: {"density": {"l1", ...}, ..., "binned_density_l1"}. */
json_t *run_errors_json(const struct run_result *result);

/* One line on the interpolation error of a user's table; "" without a table. */
void run_interpolation_text(const double interpolation[FIELDS], char *text, size_t size);

/* {"undisturbed": {"density", ...}, ..., "still"}; null without regions. New reference. */
json_t *run_budget_json(const struct budget *budget);

/* [lo, hi] of an interval, {"lo", "hi"} of a box, {"centre", "radius"} of a ball. New reference. */
json_t *run_window_json(const struct window *window);

/* [{"name", "value", "reference"}]; owned by the caller. */
json_t *run_functionals_json(const struct run_result *result);

/* Adds to "conservation": "ke_rebound" and "ke_asymmetry" (null unless the exact flow is steady),
 * and "centre" in particle spacings. Unknown values are null. */
void run_add_motion(const struct run_result *result, const struct trace_motion *motion,
                    json_t *conservation);

/* The drifts of the sums as the first members of "conservation"; "angular_momentum" is null in 1D.
 */
json_t *run_drift_json(int dim, const struct trace_drift *drift);

/* Adds all members of a result of kind `run` to a document (see result_new). */
void run_add_json(const struct run_settings *settings, const struct run_result *result,
                  json_t *document);

/* Adds what is known before a run: case, settings, n, plan and warnings. */
void run_add_plan(const struct run_settings *settings, const struct run_result *result,
                  json_t *document);

double run_error(const struct run_result *result, enum field field, enum norm norm);

/* Writes the final state in the format chosen by the suffix of path (snapshot_writer.h).
 * STATUS_BAD_INPUT: unknown suffix; STATUS_ENVIRONMENT: the file cannot be written. */
enum status run_write_snapshot(const struct run_result *result, const char *path,
                               struct error *error);
