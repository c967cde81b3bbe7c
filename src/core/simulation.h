/* SPDX-License-Identifier: GPL-3.0-or-later
 * The interface of the solver: takes a setup, provides particles and costs. Code units throughout.
 */
#ifndef SPHPROOF_SIMULATION_H
#define SPHPROOF_SIMULATION_H

#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

#include "serialiser.h"
#include "scheme.h"
#include "status.h"

/* The problem to be computed. The caller owns the arrays; simulation_create and simulation_take
 * copy them. */
struct setup {
    int dim;                   /* 1, 2 or 3 */
    double lo[3], hi[3];       /* box */
    enum boundary boundary[3]; /* of each axis */
    double gravity[3];         /* constant acceleration; must be 0 in 1D */
    double gamma;              /* ideal gas, > 1 */
    double t_end;
    size_t n;           /* particles */
    const double *x[3]; /* n each: positions, in the box, any order */
    const double *v[3]; /* n each: velocities */
    const double *m;    /* n: masses, > 0 */
    const double *u;    /* n: specific internal energies, > 0 */
    const double *rho;  /* n: first guess of the density, or NULL */
    struct scheme scheme;
    bool skip;    /* allow sleep.h to skip work */
    bool generic; /* the oracle: loops with all choices at run time */
    int threads;  /* >= 1 */
};

/* One line of the plan: a pass, whether it runs, and why (not). */
struct plan_line {
    const char *pass;
    bool runs;
    char why[160];
};

struct simulation_cost {
    double wall_s, cpu_s; /* from the creation of the particles to t_end; cpu_s: all threads */
    uint64_t steps, particle_updates, pair_interactions, skipped_particle_updates;
    /* Numbers of particles without a usable moment matrix (CONVENTIONS eq. 4.7), all of whose pairs
     * took the standard gradient: summed over the evaluations, and the largest in one. */
    uint64_t fallen_back, fallen_back_most;
    /* Numbers of particles whose velocity gradient, viscosity or conductivity was skipped because
     * it vanishes, summed over the evaluations. */
    uint64_t without_slope, without_viscosity, without_conductivity;
};

/* Read-only view of the state: n values each, sorted by position if dim = 1, positions wrapped into
 * the box. Valid until the simulation advances or is destroyed. */
struct snapshot {
    size_t n;
    const double *x[3], *v[3];
    const double *m, *rho, *u, *P, *h, *volume;
    const size_t *id; /* index in the setup */
    double time;
};

/* The rates at the beginning of the next step: dp/dt, de/dt (of U or E, whichever the scheme
 * integrates), dalpha/dt (NULL if alpha does not evolve), in the order of the snapshot. Right after
 * simulation_create they are those of the initial state. */
struct rates {
    const double *force[3], *energy, *alpha;
    /* by particle shifting, not included above; NULL: particles move with the flow */
    struct {
        const double *velocity[3], *mass, *momentum[3], *energy;
    } shift;
    double time_step;
    double furthest; /* upper bound of the next step; with steps=local, of a block of steps */
};

struct conservation { /* sums over all particles, code units */
    double mass, momentum[3], momentum_scale /* sum |p| */, sound_scale /* sum m c */, energy;
    double kinetic; /* sum p^2/2m, included in energy */
    /* about the middle of the box, with positions wrapped into periodic boxes; 0 in 1D */
    double angular_momentum[3], angular_scale /* sum |r x p| */, turning_scale /* sum |r| m c */;
};

/* Writes the plan of a setup to lines (at most max) and returns their total number; runs nothing.
 * warnings (may be NULL): receives one text, "" if none, e.g. if eta is off a partition-of-unity
 * width. */
size_t plan_explain(const struct setup *setup, struct plan_line *lines, size_t max, char *warnings,
                    size_t warnings_size);

/* Checks that shifting is compatible with the setup's boundaries and gravity, as simulation_create
 * does; reads no particles. STATUS_BAD_INPUT names both of two incompatible choices. */
enum status simulation_check_shifting(const struct setup *setup, struct error *error);

struct simulation;

/* Allocates all memory of a run; simulation_run allocates more only if neighbours become eight
 * times as far apart in the order of positions as at the start. */
enum status simulation_create(const struct setup *setup, struct simulation **simulation,
                              struct error *error);
/* simulation_create in two parts: after simulation_take the caller may free the setup's arrays, and
 * simulation_begin then has this memory for the neighbour lists. If simulation_begin fails, only
 * simulation_destroy is allowed. */
enum status simulation_take(const struct setup *setup, struct simulation **simulation,
                            struct error *error);
enum status simulation_begin(struct simulation *simulation, struct error *error);
/* Called after each step with the current time; returns false to stop (STATUS_OK, time < t_end). */
typedef bool simulation_progress(void *context, double time, uint64_t steps);

/* Advances to t_end exactly. STATUS_BROKE_DOWN: the message names particle, time and quantity, and
 * the state is the last valid one. progress may be NULL. */
enum status simulation_run(struct simulation *simulation, double t_end,
                           simulation_progress *progress, void *context, struct error *error);
/* Saves everything that the next step depends on, or (serialiser->back) restores it to a simulation
 * that was created from the same setup by the same build and that then continues with identical
 * bits. To be called between steps: from simulation_progress, or before simulation_run. The caller
 * checks serialiser->failed; after a failed restore only simulation_destroy is allowed. */
void simulation_serialise(struct simulation *simulation, struct serialiser *serialiser);
void simulation_snapshot(const struct simulation *simulation, struct snapshot *snapshot);
/* asleep[i]: whether particle i, in the order of the snapshot, is skipped in the sums; n values. */
void simulation_asleep(const struct simulation *simulation, bool *asleep);
void simulation_rates(const struct simulation *simulation, struct rates *rates);
void conservation_sums(const struct simulation *simulation, struct conservation *sums);
void simulation_cost(const struct simulation *simulation, struct simulation_cost *cost);
/* Frees the neighbour lists. Afterwards no step and no description is allowed. */
void simulation_end(struct simulation *simulation);
void simulation_destroy(struct simulation *simulation);

#endif
