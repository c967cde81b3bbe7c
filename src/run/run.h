/* SPDX-License-Identifier: GPL-3.0-or-later
 * One run: settings as asked -> resolved, once -> particles -> simulation -> errors, conservation,
 * cost. The one way in which the commands run, converge, bench, report and stress compute
 * anything. */
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

/* What a solver leaves behind. */
struct run_outcome {
    enum status status; /* of the run */
    struct error reason;
    struct conservation start, end;
    struct simulation_cost cost;
    struct snapshot snapshot;     /* its arrays belong to the solver, until it is released */
    void *owned;                  /* by the solver */
    void (*release)(void *owned); /* NULL: there is nothing to release */
};

/* Another solver than that of the core: runs a setup to its t_end. A status that is neither
 * STATUS_OK nor STATUS_BROKE_DOWN leaves no snapshot. */
typedef void run_solver(const struct setup *setup, struct run_outcome *outcome);

struct run;

/* Another program that computes runs, from outside of this one: begins what its maker knows of it.
 */
struct run_external {
    const char *title;
    /* Adds all that decides the result beside the case and its keys. STATUS_BAD_INPUT: keys that
     * mean nothing to it. */
    enum status (*add_key)(const struct run_external *external, const struct run *run, json_t *key,
                           struct error *error);
    /* The document of `sphproof run`, with its profile if that is wanted. STATUS_BROKE_DOWN: the
     * run has failed, which the document says. */
    enum status (*compute)(const struct run_external *external, const struct run *run, bool profile,
                           json_t **document, struct error *error);
    /* Adds "code", what it is, to the document of many runs. */
    void (*describe)(const struct run_external *external, json_t *document);
};

struct run_settings {
    struct case_file file;
    struct settings settings; /* the case's with the user's on top; `auto` still in it */
    int threads;              /* >= 1 */
    bool any_window;          /* run also where the mirrored tube reaches the window */
    bool generic;             /* by the loops that look every choice up */
    int layers;               /* of run_start: a plane as so many layers in space; 0: as it is */
    bool equal_masses;        /* of run_start: particles of equal masses, or none */
    run_solver *solver;       /* computes the run; NULL: the core solver */
    const struct run_external *external; /* computes its document; NULL: this program */
    simulation_progress *progress;       /* called every 32 steps; may be NULL */
    void *progress_context;
    bool each_step;                /* it is called after each: they may be long */
    struct checkpoint *checkpoint; /* where the run's state is kept; NULL: nowhere */
    struct snapshots *snapshots;   /* snapshots on the way; NULL: none */
    struct trace *trace;           /* {0}: receives the time series; NULL: none is kept */
};

/* A run with every choice made: no `auto` is left, and the exact solution is known. Its cache key,
 * plan and result all come from here; resolve again after a change of a key. What is asked beside
 * the keys (threads, progress, trace ...) may still be changed. */
struct run {
    struct run_settings asked;
    struct settings settings;
    struct scheme scheme;
    struct prepared problem;
};

/* A scalar of the final state, for extrapolation where no exact value is at hand. */
struct run_functional {
    const char *name;
    double value, exact;
};

/* How far a wave's numerical width reaches, in the particle's h. */
#define BUDGET_REACH 3.

/* Where the error comes from: its L1 norm by the regions of the problem (problem.h), and whether
 * gas that no wave has reached is still as it was. */
struct budget {
    const struct regions *regions; /* NULL: the problem has none */
    /* L1 = sum over regions; 0 where a region is not in the window */
    double l1[PROBLEM_REGIONS_MAX][FIELDS];
    double still; /* max |v - v0|/c in undisturbed gas of the whole box; NaN: too few particles */
};

struct run_result {
    enum status status;       /* STATUS_OK or STATUS_BROKE_DOWN */
    char message[512];        /* how it broke down */
    char case_name[256];      /* as case_load knows it; "": none was given */
    struct settings settings; /* as used: these three are the run's */
    struct scheme scheme;
    struct prepared problem;
    size_t n;
    double time;
    struct norms errors[FIELDS]; /* at time; NaN where no particle is in the window; of the velocity
                                    in 2D and 3D: |v - exact| */
    struct norms azimuthal, radial; /* of the velocity of a circular flow */
    double binned_density_l1;       /* in 1D */
    double interpolation[FIELDS];   /* what a user's table may be off (own_miss); NaN: none is */
    struct regularity regularity;   /* of the final state, with the scheme's kernel */
    struct estimate estimate;       /* before the run */
    struct relax_quality start;     /* of a glass; NaN: it is none */
    size_t crossed;       /* neighbours of the start that are not next to each other any more */
    double spacing, h;    /* (box/n)^(1/d); mean smoothing length in the window, by volume */
    struct budget budget; /* L1 by regions of the problem */
    /* conservation: relative, >= 0: see trace_drift; momentum only along directions without walls,
     * layers and gravity */
    double mass, momentum, angular_momentum, energy;
    struct trace_motion motion; /* NaN: not known */
    struct simulation_cost cost;
    struct description_sums matrix; /* at time; none after a breakdown */
    double peak_rss;                /* bytes, of the process so far */
    struct plan_line plan[RUN_PLAN_MAX];
    size_t plan_count;
    char warnings[512];
    char suspicion[SUSPICION_TEXT]; /* "" unless the errors look wrong in themselves */
    struct run_functional functionals[PROBLEM_FUNCTIONALS_MAX];
    size_t functional_count;
    struct growth growth;     /* of a problem in which something grows */
    struct snapshot snapshot; /* owned by the result: see run_free */
    double *storage;
};

/* Loads a case and applies KEY=VALUE arguments. */
enum status run_prepare(struct run_settings *settings, const char *case_name, int n,
                        char *const *arguments, struct error *error);

/* STATUS_BAD_INPUT: keys that cannot be together, or that no problem or scheme can be made of. */
enum status run_resolve(struct run *run, const struct run_settings *asked, struct error *error);

/* What the solver is given; initial: of the run's problem. */
struct setup run_setup(const struct run *run, const struct initial *initial);

/* Runs. STATUS_OK and STATUS_BROKE_DOWN leave a result (run_free it), anything else none:
 * STATUS_BAD_INPUT where the exact solution does not hold in the window up to t_end, and for
 * liquids. */
enum status run_execute(const struct run *run, struct run_result *result, struct error *error);

/* All but the simulation: plan, estimate and warnings filled; n is what it would be. STATUS_*: as
 * run_execute, also STATUS_ENVIRONMENT where memory will not do. */
enum status run_explain(const struct run *run, struct run_result *result, struct error *error);

/* No step: the state at t = 0 of the very particles that run_execute starts from, with the density
 * and smoothing length that its solver finds; nothing is measured. With asked.layers it is in 3D
 * (see slab.h), and the problem of the result serves for box, boundary and gamma alone. STATUS_*:
 * as run_execute, and only STATUS_OK leaves a result. */
enum status run_start(const struct run *run, struct run_result *result, struct error *error);

/* Asks run_start for equal masses, and the case's problem by the keys with which it lays them. */
enum status run_ask_equal_masses(struct run_settings *asked, struct error *error);

/* No run: errors and functionals of a state that another code has computed, by the problem of a run
 * whose t_end is the state's time. In 1D sorted by position; id: 0 ... n - 1.
 * STATUS_BAD_INPUT where the exact solution does not hold in the window. */
enum status run_judge(const struct run *run, const struct snapshot *snapshot,
                      struct run_result *result, struct error *error);
void run_free(struct run_result *result);

/* "errors" of a result document: {"density": {"l1", ...}, ..., "binned_density_l1"}. */
json_t *run_errors_json(const struct run_result *result);

/* What interpolation in a user's table may be off, in a line; "" where there is no table. */
void run_interpolation_text(const double interpolation[FIELDS], char *text, size_t size);

/* {"undisturbed": {"density", ...}, ..., "still"}; null where there are no regions. New reference.
 */
json_t *run_budget_json(const struct budget *budget);

/* [lo, hi] of an interval, {"lo", "hi"} of a box, {"centre", "radius"} of a ball. New reference. */
json_t *run_window_json(const struct window *window);

/* [{"name", "value", "reference"}]; owned by the caller. */
json_t *run_functionals_json(const struct run_result *result);

/* Adds "ke_rebound" and "ke_asymmetry" (null unless the exact flow is steady), and "centre", in
 * particle spacings, to what is conserved; null where they are not known. */
void run_add_motion(const struct run_result *result, const struct trace_motion *motion,
                    json_t *conservation);

/* Adds everything that a result of kind `run` has to a document (see result_new). */
void run_add_json(const struct run_settings *settings, const struct run_result *result,
                  json_t *document);

/* What is known before a run: case, settings, n, plan and warnings. */
void run_add_plan(const struct run_settings *settings, const struct run_result *result,
                  json_t *document);

double run_error(const struct run_result *result, enum field field, enum norm norm);

/* The state at the end in the format that the ending of path means, of those in snapshot_writer.h.
 * STATUS_BAD_INPUT: an ending that means none; STATUS_ENVIRONMENT: it cannot be written. */
enum status run_write_snapshot(const struct run_result *result, const char *path,
                               struct error *error);
