/* SPDX-License-Identifier: GPL-3.0-or-later
 * Inside of a simulation: shared by its passes and the integrators, for nobody else. */
#ifndef SPHPROOF_SOLVER_H
#define SPHPROOF_SOLVER_H

#include <stdbool.h>

#include "integrator.h"
#include "loops.h"
#include "particles.h"
#include "plan.h"
#include "simulation.h"
#include "sleep.h"

enum { WORTH_A_THREAD = 32 }; /* ranges: with fewer of them threads cost more than they save */

/* Up to RANGE_MAX neighbouring particles that are worked on together. */
struct range {
    ptrdiff_t first;
    int len;
    ptrdiff_t reach;       /* neighbour offsets that suffice for the particles' own h */
    ptrdiff_t force_reach; /* and for pairs within max(h_i, h_j) */
    uint64_t done;         /* the density pass in which the widths were found */
    uint64_t predicted;    /* the one in which they were predicted */
};

struct simulation {
    struct scheme scheme;
    struct plan plan;
    struct loops loops;
    struct particles particles;
    double lo, period, gamma, time, t_end;
    double time_step;     /* limit found by the last signal speeds */
    double last_dt;       /* of the last step, 0 before the first */
    double largest_dt;    /* of all steps */
    double start_energy;  /* total */
    double ahead;         /* the step whose middle x, v, U and alpha are at already; 0: none */
    double predict_ratio; /* of the prediction of h: this interval / the last one */
    int threads;
    struct sleep sleep;
    struct range *ranges; /* of the awake particles */
    ptrdiff_t range_count;
    ptrdiff_t ghosts_filled;
    ptrdiff_t reach;         /* largest of the ranges */
    uint64_t density_passes; /* so far; ranges know by it what belongs to this one */
    double *scratch;         /* threads * scratch_size */
    size_t scratch_size;
    struct simulation_cost cost;
    double wall_start, cpu_start;
    double *wrapped, *specific_energy; /* of the snapshot, n each */
};

/* --- passes (evaluate.c) ---------------------------------------------------------------------- */

/* Order, density and smoothing length, equation of state: everything that a state implies. */
enum status evaluate_state(struct simulation *simulation, struct error *error);
/* And the rates dp/dt, de/dt, dalpha/dt with the time-step limit. */
enum status evaluate_rates(struct simulation *simulation, struct error *error);
/* The same where x, v and U are there already (an integrator that predicts them directly). */
enum status evaluate_rates_of_primitives(struct simulation *simulation, struct error *error);
/* The time-step limit alone, where velocities have changed since the last rates. */
void evaluate_signal(struct simulation *simulation);

/* After the first rates: sets memory aside for neighbours eight times as far apart in the order as
 * they are then, which is more than a shock brings. Only where they get beyond that does a step
 * ask for memory, each time for half as much again at least. */
enum status evaluate_reserve(struct simulation *simulation, struct error *error);

/* --- the time step (simulation.c) ------------------------------------------------------------- */

/* The step that begins at time, from the last limit; 0 where none is to follow. */
double simulation_next_step(const struct simulation *simulation, double time);
/* The time after a step dt from the present time. */
double simulation_time_after(const struct simulation *simulation, double dt);

/* A breakdown at particle i: quantity = value, at the current time. Returns STATUS_BROKE_DOWN. */
enum status broke_down(const struct simulation *simulation, ptrdiff_t i, const char *quantity,
                       double value, struct error *error);

#endif
