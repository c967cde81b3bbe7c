/* SPDX-License-Identifier: GPL-3.0-or-later
 * The internals of a simulation, used only by its passes and the integrators. */
#ifndef SPHPROOF_SOLVER_H
#define SPHPROOF_SOLVER_H

#include <stdbool.h>

#include "integrator.h"
#include "particles.h"
#include "plan.h"
#include "simulation.h"
#include "sleep.h"
#include "steps.h"
#include "sums.h"
#include "team.h"

enum { WORTH_A_THREAD = 32 }; /* batches per thread: with fewer, threads cost more than they save */

struct simulation {
    struct scheme scheme;
    struct plan plan;
    struct particles particles;
    void *workspace;        /* owned by struct sums */
    void *integrator_state; /* owned by the integrator */
    double lo[3];           /* of the box */
    enum boundary boundary[3];
    double gravity[3];
    double *held; /* by id, see fixed.c: 0 for moving particles; NULL: all move */
    double gamma, time, t_end;
    double time_step;     /* limit from the last signal speeds */
    double dt, dt_before; /* current or last step, and the one before; 0: none */
    double largest_dt;    /* of all steps */
    double start_energy;  /* total */
    struct team team;     /* threads */
    struct sleep sleep;
    struct steps steps;
    struct simulation_cost cost;
    double wall_start, cpu_start;
    double *wrapped[3]; /* positions of the snapshot, n each */
};

/* True if the current evaluation computes the rates of particle i. */
static inline bool simulation_evaluates(const struct simulation *simulation, ptrdiff_t i)
{
    const int level = simulation->steps.level;
    return level < 0 || (int)simulation->particles.level[i] == level;
}

/* --- the evaluation (evaluate.c) -------------------------------------------------------------- */

/* Computes order, density, smoothing length and equation of state from the state. */
enum status evaluate_state(struct simulation *simulation, struct error *error);
/* Computes these and the rates dp/dt, de/dt, dalpha/dt and the time-step limit. */
enum status evaluate_rates(struct simulation *simulation, struct error *error);
/* As evaluate_rates, with given x, v and U (for an integrator that predicts them directly). */
enum status evaluate_rates_of_primitives(struct simulation *simulation, struct error *error);
/* As evaluate_rates, after a change of p, e and alpha only: neighbours and smoothing lengths are
 * those of the previous evaluation. */
enum status evaluate_rates_in_place(struct simulation *simulation, struct error *error);
/* Recomputes only the time-step limit, from velocities that have changed since the last rates. */
void evaluate_signal(struct simulation *simulation);

/* --- the step (simulation.c) ------------------------------------------------------------------ */

/* The length of the step that begins at `time`, from the last limit; 0 if no step follows. */
double simulation_next_step(const struct simulation *simulation, double time);
/* The time after a step dt from the current time. */
double simulation_time_after(const struct simulation *simulation, double dt);

#endif
