/* SPDX-License-Identifier: GPL-3.0-or-later
 * The solver as its users see it: a setup in, particles and costs out. Code units throughout. */
#ifndef SPHPROOF_SIMULATION_H
#define SPHPROOF_SIMULATION_H

#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

#include "serialiser.h"
#include "scheme.h"
#include "status.h"

/* What is to be computed. Arrays belong to the caller and are copied by simulation_create and
 * simulation_take. */
struct setup {
    int dim;                   /* 1, 2 or 3 */
    double lo[3], hi[3];       /* box */
    enum boundary boundary[3]; /* in each direction */
    double gravity[3];         /* constant acceleration; needs 2 or 3 dimensions where not 0 */
    double gamma;              /* ideal gas, > 1 */
    double t_end;
    size_t n;           /* particles */
    const double *x[3]; /* n each: positions, in the box, any order */
    const double *v[3]; /* n each: velocities */
    const double *m;    /* n: masses, > 0 */
    const double *u;    /* n: specific internal energies, > 0 */
    const double *rho;  /* n: first guess of the density, or NULL */
    struct scheme scheme;
    bool skip;    /* leave out work: sleep.h */
    bool generic; /* the oracle: loops with every choice looked up at run time */
    int threads;  /* >= 1 */
};

/* One line of the plan: a pass, whether it runs, and why (or why not). */
struct plan_line {
    const char *pass;
    bool runs;
    char why[160];
};

struct simulation_cost {
    double wall_s, cpu_s; /* set-up of the particles to t_end; cpu_s: all threads */
    uint64_t steps, particle_updates, pair_interactions, skipped_particle_updates;
    /* particles whose moment matrix could not be used (CONVENTIONS eq. 4.7), summed over the
     * evaluations, and the most of one: all their pairs used the standard gradient */
    uint64_t fallen_back, fallen_back_most;
    /* particles whose velocity gradients, viscosity and conductivity were left out, as they vanish;
     * summed over the evaluations */
    uint64_t without_slope, without_viscosity, without_conductivity;
};

/* The state, for reading: n values each, sorted by position where dim = 1; positions wrapped into
 * the box by snapshot_*; valid until the simulation moves on or is destroyed. */
struct snapshot {
    size_t n;
    const double *x[3], *v[3];
    const double *m, *rho, *u, *P, *h, *volume;
    const size_t *id; /* index in the setup */
    double time;
};

/* The rates that the next step begins with: dp/dt, de/dt (of U or E, as the scheme integrates),
 * dalpha/dt (NULL where alpha does not evolve), in the order of the snapshot. Right after
 * simulation_create they belong to the initial state. */
struct rates {
    const double *force[3], *energy, *alpha;
    /* of particle shifting, in none of the above; NULL: particles move with the flow */
    struct {
        const double *velocity[3], *mass, *momentum[3], *energy;
    } shift;
    double time_step;
    double furthest; /* the next step is no longer: with steps=local a block of time steps */
};

struct conservation { /* sums over all particles; extensive, code units */
    double mass, momentum[3], momentum_scale /* sum |p| */, sound_scale /* sum m c */, energy;
    double kinetic; /* the part of the energy that is sum p^2/2m */
    /* about the middle of the box, of positions wrapped into it where it is periodic; 0 in 1D */
    double angular_momentum[3], angular_scale /* sum |r x p| */, turning_scale /* sum |r| m c */;
};

/* Builds the plan for a setup into lines (at most max), returns how many it has; runs nothing.
 * warnings (may be NULL): one text, "" if none, e.g. eta off a partition-of-unity width. */
size_t plan_explain(const struct setup *setup, struct plan_line *lines, size_t max, char *warnings,
                    size_t warnings_size);

/* Checks that shifting goes with the setup's ends and gravity, which simulation_create does as well;
 * of the particles nothing is read. STATUS_BAD_INPUT names the two that exclude each other. */
enum status simulation_check_shifting(const struct setup *setup, struct error *error);

struct simulation;

/* Allocates all that a run needs; simulation_run asks for more only where neighbours get eight
 * times as far apart in the order of positions as they are at the start. */
enum status simulation_create(const struct setup *setup, struct simulation **simulation,
                              struct error *error);
/* The same in two parts, for who has no use for the setup's arrays after the first one: what they
 * take is then there for the neighbours. Without success in the second part only
 * simulation_destroy is allowed. */
enum status simulation_take(const struct setup *setup, struct simulation **simulation,
                            struct error *error);
enum status simulation_begin(struct simulation *simulation, struct error *error);
/* Called after each step with the current time; return false to stop (STATUS_OK, time < t_end). */
typedef bool simulation_progress(void *context, double time, uint64_t steps);

/* Steps to t_end exactly. STATUS_BROKE_DOWN: the message names particle, time and quantity; the
 * state is then the last sound one. progress may be NULL. */
enum status simulation_run(struct simulation *simulation, double t_end,
                           simulation_progress *progress, void *context, struct error *error);
/* Hands over all that the next step depends on: to be kept, or (serialiser->back) as it was kept,
 * into a simulation that was created of the same setup by the same build and then goes on to the
 * last bit as the one that was kept. Between steps: from simulation_progress, or before
 * simulation_run. Look at serialiser->failed; after a failure on the way back only
 * simulation_destroy is allowed. */
void simulation_serialise(struct simulation *simulation, struct serialiser *serialiser);
void simulation_snapshot(const struct simulation *simulation, struct snapshot *snapshot);
/* Whether each particle, in the order of a snapshot, is left out of the sums: n values. */
void simulation_asleep(const struct simulation *simulation, bool *asleep);
void simulation_rates(const struct simulation *simulation, struct rates *rates);
void simulation_conservation(const struct simulation *simulation, struct conservation *sums);
void simulation_cost(const struct simulation *simulation, struct simulation_cost *cost);
/* Frees the neighbour lists. No step and no description may follow. */
void simulation_end(struct simulation *simulation);
void simulation_destroy(struct simulation *simulation);

#endif
