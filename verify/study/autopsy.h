/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds why a scheme loses its order, on problems with a smooth exact solution: splits the error of
 * the velocity over a ladder of resolutions into parts. Two of them are measured on whole runs (the
 * time step, and the effect of the measure on exact fields) and the others on single evaluations of
 * the acceleration, where every particle has the exact velocity and energy, against the exact
 * acceleration -grad P/rho + g: at the regular initial positions and at the positions that the run
 * itself has reached. Code units. */
#pragma once

#include <jansson.h>

#include "order.h"
#include "regularity.h"
#include "run.h"

enum autopsy_part {
    AUTOPSY_TIME_STEP,  /* error of the run minus that of a run with a quarter of the time step */
    AUTOPSY_MEASURE,    /* error that the measure finds for exact fields */
    AUTOPSY_REFERENCE,  /* residual of the exact solution in its equation of motion */
    AUTOPSY_OPERATOR,   /* gradient at regular positions, with the exact pressure */
    AUTOPSY_DENSITY,    /* at regular positions: pressure from the SPH density */
    AUTOPSY_DISORDER,   /* at the run's own positions: additional error to regular ones */
    AUTOPSY_VISCOSITY,  /* at the run's own positions: artificial viscosity of the exact flow, */
    AUTOPSY_NOISE_TERM, /* without its term that only damps noise, which is this part */
    AUTOPSY_CONDUCTION, /* likewise: its rate of pressure change over rho c */
    AUTOPSY_PARTS
};
extern const struct family autopsy_part_family;

/* Shares of an error, as results name them; each sums one or more parts. */
enum autopsy_share {
    AUTOPSY_OF_OPERATOR,
    AUTOPSY_OF_DISORDER,
    AUTOPSY_OF_VISCOSITY, /* all dissipative terms */
    AUTOPSY_OF_TIME_STEP,
    AUTOPSY_OF_VOLUME,  /* volume elements: the density at regular positions */
    AUTOPSY_OF_MEASURE, /* and the exact solution */
    AUTOPSY_SHARES
};
extern const struct family autopsy_share_family;

/* Terms that exchange energy between flow and heat. */
enum autopsy_term {
    AUTOPSY_PRESSURE,
    AUTOPSY_VISCOUS, /* without the noise term */
    AUTOPSY_NOISE,   /* the term of a viscosity that only damps noise */
    AUTOPSY_CONDUCTIVITY,
    AUTOPSY_TERMS
};
extern const struct family autopsy_term_family;

/* Power of a term on all particles: work on the flow, heat, and the sum of the absolute values over
 * single particles. Pressure and viscosity conserve energy: work + heat is round-off. */
struct autopsy_power {
    double work, heat, scale;
};

/* A vector field on particles: its rms over the window; its noise, the rms deviation from the best
 * linear functions in cells of 4 spacings; and the component of the smooth rest along the
 * velocity's error (or the whole rest if that is unknown), because accelerations that alternate
 * cause less error than steady ones. */
struct autopsy_split {
    double rms, noise, along;
};

struct autopsy_level {
    size_t n;
    double spacing;  /* (box/n)^(1/d) */
    double error[3]; /* L1 of the velocity at t_end; with 1/2 and 1/4 of the step */
    struct autopsy_split size[AUTOPSY_PARTS]; /* the first two are velocities without noise, the
                                                 others accelerations */
    double share[AUTOPSY_PARTS]; /* of the error: >= 0, sum 1 (NaN: there is no error) */
    /* rms error of the acceleration of exact fields without viscosity: at the initial positions, at
     * the run's own at t_end, and at the initial ones moved at random by 0.2 spacings */
    double regular, own, jittered;
    double acceleration; /* rms of the exact one at t_end */
    double round_off;    /* of accelerations; a smaller part counts as 0 */
    /* L1 of the density: of the run at t_end, and at the regular initial positions, where the mean
     * density is `compression` times the exact one */
    double density, density_regular, compression;
    struct autopsy_split velocity; /* the velocity's error at t_end */
    struct autopsy_power
        power[AUTOPSY_TERMS];     /* at t_end, with the initial values of evolving alphas */
    struct regularity regularity; /* at t_end */
};

struct autopsy {
    int dim;
    size_t count; /* levels, coarsest first */
    struct autopsy_level levels[CASE_LADDER_MAX];
    /* set by autopsy_judge: */
    struct order_fit order,
        orders[AUTOPSY_PARTS]; /* of the error; of the sizes (NaN: zero at a level) */
    struct order_fit regular, own, jittered;
    /* of share x error; NaN: zero at a level */
    struct order_fit losses[AUTOPSY_PARTS], share_orders[AUTOPSY_SHARES];
    bool theirs;             /* of snapshots: viscosity and time step are unknown */
    bool lost;               /* the order is below AUTOPSY_ORDER */
    enum autopsy_part cause; /* largest part at the finest level; if the order is lost, among those
                                whose share of the error falls as slowly */
    size_t from;             /* first level from which on `cause` is the largest of them */
    bool floor;              /* error at regular positions that does not fall: lattice sums */
    struct trace trace;      /* of the finest level: regularity of the particles over time */
    char sentence[480];      /* the result in a sentence */
};

/* An order below this is lost: second order, within the accuracy of a fit. */
#define AUTOPSY_ORDER 1.8
/* An error at regular positions with a lower order is a floor. */
#define AUTOPSY_FLOOR 0.5

/* STATUS_BAD_INPUT: the run's problem is not smooth, or its solution is unknown. */
enum status autopsy_check(const struct run *run, struct error *error);

/* Costs seven runs; keeps the trace of the run itself. STATUS_*: as run_execute. */
enum status autopsy_measure(const struct run *run, struct autopsy_level *level, struct trace *trace,
                            struct error *error);

/* Measures all levels of a ladder of rising n, at least ORDER_LEVELS_MIN, and calls autopsy_judge.
 * *last: the finest run. Checks all levels before the first run starts. */
enum status autopsy_ladder(const struct run_settings *settings, const size_t *ladder, size_t count,
                           struct autopsy *autopsy, struct run *last, struct error *error);

/* Errors that the particles of any code's snapshot make of exact fields, with the operator of a run
 * that ends at its time; result: of run_judge. Time step and viscosity stay 0. */
enum status autopsy_measure_theirs(const struct run *run, const struct run_result *result,
                                   struct autopsy_level *level, struct error *error);

/* Orders and sentence for count levels of rising n, at least ORDER_LEVELS_MIN; fewer, which have no
 * orders, are allowed for snapshots (`theirs`). */
enum status autopsy_judge(struct autopsy *autopsy, struct error *error);

/* A share of the error at a level: the sum of its parts. */
double autopsy_share(const struct autopsy_level *level, enum autopsy_share share);

/* Adds "case", "title", "settings", "shares", "sentence", "levels", "orders", "cause" and more to a
 * document. */
void autopsy_add_case(const struct run *finest, const struct autopsy *autopsy, json_t *document);
