/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a scheme loses its order to, on problems whose exact solution is smooth: the error of the
 * velocity over a ladder of resolutions, taken apart. Three parts are measured on whole runs (the
 * time step, what the measure makes of exact fields) and the others on single evaluations of the
 * acceleration where every particle has the exact velocity and energy, against the exact
 * acceleration -grad P/rho + g: at the regular positions of the start and at the positions that the
 * run itself has come to. Code units. */
#pragma once

#include <jansson.h>

#include "order.h"
#include "regularity.h"
#include "run.h"

enum autopsy_part {
    AUTOPSY_TIME_STEP,  /* error of the run less that of the run with a quarter of the time step */
    AUTOPSY_MEASURE,    /* error that is measured where all fields are exact */
    AUTOPSY_REFERENCE,  /* what the exact solution misses of its own equation of motion */
    AUTOPSY_OPERATOR,   /* at regular positions, with the exact pressure: the gradient */
    AUTOPSY_DENSITY,    /* at regular positions: pressure of the density that particles have */
    AUTOPSY_DISORDER,   /* at the run's own positions: what regular ones do not have */
    AUTOPSY_VISCOSITY,  /* at the run's own positions: artificial viscosity of the exact flow, */
    AUTOPSY_NOISE_TERM, /* without its term that damps noise alone, which is this one */
    AUTOPSY_CONDUCTION, /* likewise: how fast it changes pressures, over rho c */
    AUTOPSY_PARTS
};
extern const struct family autopsy_part_family;

/* The shares of an error, by the words that results have for them; each sums one or more parts. */
enum autopsy_share {
    AUTOPSY_OF_OPERATOR,
    AUTOPSY_OF_DISORDER,
    AUTOPSY_OF_VISCOSITY, /* all terms that dissipate */
    AUTOPSY_OF_TIME_STEP,
    AUTOPSY_OF_VOLUME,  /* volume elements: the density at regular positions */
    AUTOPSY_OF_MEASURE, /* and the exact solution */
    AUTOPSY_SHARES
};
extern const struct family autopsy_share_family;

/* What moves energy between flow and heat. */
enum autopsy_term {
    AUTOPSY_PRESSURE,
    AUTOPSY_VISCOUS, /* without the next one */
    AUTOPSY_NOISE,   /* the term of a viscosity that damps noise alone */
    AUTOPSY_CONDUCTIVITY,
    AUTOPSY_TERMS
};
extern const struct family autopsy_term_family;

/* A term's power on all particles: done on the flow, given as heat, and the sum of the sizes of all
 * that single particles get. Pressure and viscosity conserve energy: work + heat is round-off. */
struct autopsy_power {
    double work, heat, scale;
};

/* Of a vector field on particles: root of its mean square over the window; the part of it that
 * differs between neighbours: from the linear functions that fit best in cells of 4 spacings; and
 * what of the rest points along the velocity's error (or all of the rest, where that is not known):
 * accelerations that come and go leave no error as smooth as they are. */
struct autopsy_split {
    double rms, noise, along;
};

struct autopsy_level {
    size_t n;
    double spacing;  /* (box/n)^(1/d) */
    double error[3]; /* L1 of the velocity at t_end; with half, a quarter of the step */
    struct autopsy_split size[AUTOPSY_PARTS]; /* first two: velocities, no noise; accelerations */
    double share[AUTOPSY_PARTS]; /* of the error: >= 0, their sum is 1 (NaN: there is no error) */
    /* rms error of the acceleration without viscosity, of exact fields: at positions of the start,
     * at the run's own at t_end, at those of the start moved by 0.2 spacings at random */
    double regular, own, jittered;
    double acceleration; /* rms of the exact one at t_end */
    double round_off;    /* of accelerations; a part that is less is 0 */
    /* L1 of the density: of the run at t_end, of regular positions at the start, where it is
     * `compression` times the exact one on the whole */
    double density, density_regular, compression;
    struct autopsy_split velocity;             /* its error at t_end */
    struct autopsy_power power[AUTOPSY_TERMS]; /* at t_end; evolving alphas are as at the start */
    struct regularity regularity;              /* at t_end */
};

struct autopsy {
    int dim;
    size_t count; /* of levels, from the coarsest on */
    struct autopsy_level levels[CASE_LADDER_MAX];
    /* from autopsy_judge: */
    struct order_fit order, orders[AUTOPSY_PARTS]; /* of the error; of the sizes, n = 0: it is 0 */
    struct order_fit regular, own, jittered;
    /* of share x error; n = 0: it is 0 at a level */
    struct order_fit losses[AUTOPSY_PARTS], share_orders[AUTOPSY_SHARES];
    bool theirs;             /* of snapshots: nothing is known of viscosity and time step */
    bool lost;               /* the order is less than a smooth flow allows, AUTOPSY_ORDER */
    enum autopsy_part cause; /* the largest part at the finest level; if the order is lost, of those
                                whose share of the error falls as slowly */
    size_t from;             /* the level from which on it is the largest of them */
    bool floor;              /* it stands at regular positions and does not fall: lattice sums */
    struct trace trace;      /* of the finest level: how regular particles stand through time */
    char sentence[480];      /* all this in a sentence */
};

/* Less is lost order: second order, as far as a fit tells. */
#define AUTOPSY_ORDER 1.8
/* What falls more slowly at regular positions is a floor. */
#define AUTOPSY_FLOOR 0.5

/* STATUS_BAD_INPUT: the problem of the run is not smooth, or its solution is not known. */
enum status autopsy_check(const struct run *run, struct error *error);

/* Seven times the work of a run, whose trace is kept. STATUS_*: as run_execute. */
enum status autopsy_measure(const struct run *run, struct autopsy_level *level, struct trace *trace,
                            struct error *error);

/* All levels of a ladder of rising n, at least ORDER_LEVELS_MIN, and autopsy_judge. *last: the
 * finest run. Nothing has run before all levels are known to be allowed. */
enum status autopsy_ladder(const struct run_settings *settings, const size_t *ladder, size_t count,
                           struct autopsy *autopsy, struct run *last, struct error *error);

/* What the particles of a snapshot of any code make of exact fields with the operator of a run that
 * ends at its time; result: of run_judge. Time step and viscosity stay 0. */
enum status autopsy_measure_theirs(const struct run *run, const struct run_result *result,
                                   struct autopsy_level *level, struct error *error);

/* Orders and sentence of count levels of rising n, at least ORDER_LEVELS_MIN; of theirs fewer are
 * allowed, which have no orders. */
enum status autopsy_judge(struct autopsy *autopsy, struct error *error);

/* Share of an error at a level: the sum of its parts. */
double autopsy_share(const struct autopsy_level *level, enum autopsy_share share);

/* Adds "case", "title", "settings", "shares", "sentence", "levels", "orders", "cause" and more to a
 * document. */
void autopsy_add_case(const struct run *finest, const struct autopsy *autopsy, json_t *document);
