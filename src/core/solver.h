/* SPDX-License-Identifier: GPL-3.0-or-later
 * The inside of a simulation, shared by its passes and the integrators and by no other code. */
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

enum { WORTH_A_THREAD = 32 }; /* batches: with fewer of them threads cost more than they save */

struct simulation {
    struct scheme scheme;
    struct plan plan;
    struct particles particles;
    void *workspace;        /* what the sums keep; theirs */
    void *integrator_state; /* what the integrator keeps; its own */
    double lo[3];           /* of the box */
    enum boundary boundary[3];
    double gravity[3];
    double *held; /* by id, see fixed.c: 0 for particles that move; NULL: all do */
    double gamma, time, t_end;
    double time_step;     /* limit found by the last signal speeds */
    double dt, dt_before; /* of the step in progress or the last one, and the one before; 0: none */
    double largest_dt;    /* of all steps */
    double start_energy;  /* total */
    struct team team;     /* threads that work together */
    struct sleep sleep;
    struct steps steps;
    struct simulation_cost cost;
    double wall_start, cpu_start;
    double *wrapped[3]; /* positions of the snapshot, n each */
};

/* Does the evaluation in progress find the rates of particle i? */
static inline bool simulation_evaluates(const struct simulation *simulation, ptrdiff_t i)
{
    const int level = simulation->steps.level;
    return level < 0 || (int)simulation->particles.level[i] == level;
}

/* --- the evaluation (evaluate.c) -------------------------------------------------------------- */

/* Order, density and smoothing length, equation of state: everything that a state implies. */
enum status evaluate_state(struct simulation *simulation, struct error *error);
/* And the rates dp/dt, de/dt, dalpha/dt with the time-step limit. */
enum status evaluate_rates(struct simulation *simulation, struct error *error);
/* The same where x, v and U are there already (an integrator that predicts them directly). */
enum status evaluate_rates_of_primitives(struct simulation *simulation, struct error *error);
/* The same rates as evaluate_rates after a change of p, e and alpha alone: neighbours and widths
 * are those of the evaluation before. */
enum status evaluate_rates_in_place(struct simulation *simulation, struct error *error);
/* The time-step limit alone, where velocities have changed since the last rates. */
void evaluate_signal(struct simulation *simulation);

/* --- the step (simulation.c) ------------------------------------------------------------------ */

/* The step that begins at time, from the last limit; 0 where none is to follow. */
double simulation_next_step(const struct simulation *simulation, double time);
/* The time after a step dt from the present time. */
double simulation_time_after(const struct simulation *simulation, double dt);

#endif
