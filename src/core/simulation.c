/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "breakdown.h"
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include "fixed.h"
#include "memory.h"
#include "solver.h"
#include "width.h"

/* Ratio of a time step to the longest one of the run below which the run makes no progress. */
static const double collapse = 1e-9;

static bool collapsed(const struct simulation *simulation, double dt)
{
    return !(dt > collapse * simulation->largest_dt && simulation->time + dt > simulation->time);
}

/* Stops a run whose particles have clumped and whose steps have become short. In a healthy run a
 * particle has at most n interactions per evaluation, and the longest step is less than 100 times
 * the usual one: the largest known work is 2.8 n per longest step, in LeBlanc's problem with equal
 * numbers of particles. */
static enum status check_work(const struct simulation *simulation, struct error *error)
{
    const double n = (double)simulation->particles.n, most = 1e5 + 100 * n;
    const double steps = 1 + simulation->t_end / simulation->largest_dt;
    if ((double)simulation->cost.pair_interactions <= most * n * steps) return STATUS_OK;
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: more than %.9g pair interactions a particle for each "
                     "of the longest steps (%.9g) to t_end",
                     simulation->time, most, simulation->largest_dt);
}

static double wall_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* CPU time of all threads. CLOCK_PROCESS_CPUTIME_ID advances in ticks of 4 ms once a process has a
 * CPU time limit (ulimit -t). */
static double cpu_seconds(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static enum status check_particle(const struct setup *setup, size_t i, struct error *error)
{
    for (int k = 0; k < setup->dim; k++) {
        const bool open = setup->boundary[k] == BOUNDARY_OPEN && isfinite(setup->x[k][i]);
        if (!open && !(setup->x[k][i] >= setup->lo[k] && setup->x[k][i] <= setup->hi[k]))
            return error_set(error, STATUS_BAD_INPUT, "particle %zu: %c = %g is outside the box", i,
                             "xyz"[k], setup -> x[k][i]);
        if (!isfinite(setup->v[k][i]))
            return error_set(error, STATUS_BAD_INPUT, "particle %zu: velocity %g", i,
                             setup->v[k][i]);
    }
    if (!(setup->m[i] > 0) || !isfinite(setup->m[i]))
        return error_set(error, STATUS_BAD_INPUT, "particle %zu: mass %g must be > 0", i,
                         setup->m[i]);
    if (!(setup->u[i] > 0) || !isfinite(setup->u[i]))
        return error_set(error, STATUS_BAD_INPUT,
                         "particle %zu: specific internal energy %g must be > 0", i, setup->u[i]);
    return STATUS_OK;
}

/* Excludes open boundaries, where particles would shift into the vacuum, fixed ones, whose
 * particles would give away their fixed values, and gravity, because the fluxes contain no
 * potential energy. */
enum status simulation_check_shifting(const struct setup *setup, struct error *error)
{
    const char *chosen = scheme_shifting_family.members[setup->scheme.shifting]->name;
    for (int k = 0; k < setup->dim && setup->scheme.shifting != SHIFTING_NONE; k++) {
        const enum boundary boundary = setup->boundary[k];
        if (boundary != BOUNDARY_PERIODIC && boundary != BOUNDARY_REFLECTING)
            return error_set(error, STATUS_BAD_INPUT,
                             "shifting=%s and boundary=%s exclude each other: particles shift "
                             "between periodic and reflecting ends alone",
                             chosen, scheme_boundary_family.members[boundary]->name);
        if (setup->gravity[k] != 0)
            return error_set(error, STATUS_BAD_INPUT,
                             "shifting=%s and gravity=%g exclude each other: the exchange "
                             "knows no potential energy",
                             chosen, setup->gravity[k]);
    }
    return STATUS_OK;
}

static enum status check_setup(const struct setup *setup, struct error *error)
{
    if (!sums_find(setup->dim))
        return error_set(error, STATUS_BAD_INPUT, "dimension = %d: the solver is for dimension 1",
                         setup->dim);
    if (setup->n < 2)
        return error_set(error, STATUS_BAD_INPUT, "n = %zu: at least 2 particles", setup->n);
    if (!(setup->gamma > 1) || !isfinite(setup->gamma))
        return error_set(error, STATUS_BAD_INPUT, "gamma = %g: must be > 1", setup->gamma);
    for (int k = 0; k < setup->dim; k++) {
        const double period = setup->hi[k] - setup->lo[k];
        if (!isfinite(setup->gravity[k]) || (setup->dim == 1 && setup->gravity[k] != 0))
            return error_set(error, STATUS_BAD_INPUT,
                             "gravity = %g: finite, and 0 in 1 dimension, is needed",
                             setup->gravity[k]);
        if (!(period > 0) || !isfinite(period))
            return error_set(error, STATUS_BAD_INPUT, "box [%g, %g]: must have a positive length",
                             setup->lo[k], setup->hi[k]);
    }
    for (size_t i = 0; i < setup->n; i++) {
        const enum status status = check_particle(setup, i, error);
        if (status) return status;
    }
    const enum status shifting = simulation_check_shifting(setup, error);
    return shifting ? shifting : scheme_check(&setup->scheme, setup->dim, error);
}

/* Sets the state from the setup, with a first guess of h. */
static void set_particles(struct simulation *simulation, const struct setup *setup)
{
    struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    const struct width_rule rule = {.dim = a->dim, .eta = scheme->eta};
    const bool varies = simulation->plan.alpha || simulation->plan.jump;
    double mass = 0, volume = 1;
    for (ptrdiff_t i = 0; i < a->n; i++) mass += setup->m[i];
    for (int k = 0; k < a->dim; k++) volume *= a->period[k];
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double m = setup->m[i], u = setup->u[i];
        const double rho = setup->rho && setup->rho[i] > 0 ? setup->rho[i] : mass / volume;
        a->id[i] = (size_t)i;
        a->m[i] = m;
        a->m_inverse[i] = 1 / m;
        a->e[i] = m * u;
        for (int k = 0; k < a->dim; k++) {
            const double v = setup->v[k][i];
            a->x[k][i] = a->x_old[k][i] = setup->x[k][i];
            a->p[k][i] = m * v;
            if (scheme->energy == ENERGY_TOTAL) a->e[i] += 0.5 * m * v * v;
        }
        /* an array that is never written takes no memory */
        if (varies || a->dim == 1)
            a->alpha[i] = a->alpha_old[i] = varies ? scheme->alpha_min : scheme->alpha;
        a->h[i] = width_of(&rule, m, rho);
    }
}

static enum status allocate(struct simulation *simulation, ptrdiff_t n, struct error *error)
{
    const struct integrator *integrator = simulation->scheme.integrator;
    enum status status = simulation->plan.sums->create(simulation, n, error);
    if (status) return status;
    simulation->particles.uses = memory_uses(simulation);
    bool there = (simulation->integrator_state = calloc(1, integrator->keeps + 1));
    for (int k = 0; k < simulation->plan.dim; k++)
        there &= (simulation->wrapped[k] = malloc((size_t)n * sizeof(double))) != NULL;
    return there ? STATUS_OK
                 : error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
}

/* Copies the setup's state. */
static enum status copy_setup(struct simulation *simulation, const struct setup *setup,
                              struct error *error)
{
    for (int k = 0; k < setup->dim; k++) {
        simulation->lo[k] = setup->lo[k];
        simulation->boundary[k] = setup->boundary[k];
        simulation->gravity[k] = setup->gravity[k];
        simulation->particles.period[k] = setup->hi[k] - setup->lo[k];
    }
    set_particles(simulation, setup);
    return fixed_begin(simulation, error);
}

enum status simulation_take(const struct setup *setup, struct simulation **result,
                            struct error *error)
{
    *result = NULL;
    enum status status = check_setup(setup, error);
    if (status) return status;
    struct simulation *simulation = calloc(1, sizeof *simulation);
    if (!simulation) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    simulation->wall_start = wall_seconds();
    simulation->cpu_start = cpu_seconds();
    simulation->scheme = setup->scheme;
    simulation->plan = plan_of_setup(setup);
    simulation->gamma = setup->gamma;
    simulation->steps.level = -1;
    simulation->steps.worth = STEPS_WORTH;
    team_begin(&simulation->team, setup->threads > 1 ? setup->threads : 1);
    status = allocate(simulation, (ptrdiff_t)setup->n, error);
    if (!status) status = copy_setup(simulation, setup, error);
    if (status)
        simulation_destroy(simulation);
    else
        *result = simulation;
    return status;
}

/* Computes the rates of the first step. */
enum status simulation_begin(struct simulation *simulation, struct error *error)
{
    const struct sums *sums = simulation->plan.sums;
    struct conservation sum;
    sums->begin(simulation);
    enum status status = evaluate_rates(simulation, error);
    if (status) return status;
    conservation_sums(simulation, &sum);
    simulation->start_energy = sum.energy;
    status = sums->reserve(simulation, error);
    return status ? status : sums->sleep_begin(simulation, error);
}

enum status simulation_create(const struct setup *setup, struct simulation **simulation,
                              struct error *error)
{
    enum status status = simulation_take(setup, simulation, error);
    if (!status) status = simulation_begin(*simulation, error);
    if (!status) return STATUS_OK;
    simulation_destroy(*simulation);
    *simulation = NULL;
    return status;
}

void simulation_end(struct simulation *simulation)
{
    const struct sums *sums = simulation->plan.sums;
    if (sums->end) sums->end(simulation);
}

void simulation_destroy(struct simulation *simulation)
{
    if (!simulation) return;
    free(simulation->integrator_state);
    simulation->plan.sums->free(simulation);
    particles_destroy(&simulation->particles);
    fixed_free(simulation);
    free(simulation->sleep.spans);
    for (int k = 0; k < simulation->plan.dim; k++) free(simulation->wrapped[k]);
    free(simulation);
}

static void stop_clocks(struct simulation *simulation)
{
    simulation->cost.wall_s = wall_seconds() - simulation->wall_start;
    simulation->cost.cpu_s = cpu_seconds() - simulation->cpu_start;
}

/* The first step is at most cfl sqrt(h/a), in which a particle moves a quarter of h: signal speeds
 * depend on velocities, and so miss light particles at rest beside a high pressure. A much shorter
 * step would leave the second one, which again depends only on velocities, too long. */
static double first_time_step(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double part = simulation->scheme.integrator->first_step;
    double pull = 0; /* largest a/h */
    for (ptrdiff_t i = 0; i < a->n; i++)
        pull = fmax(pull, particles_norm(a, a->F, i) * a->m_inverse[i] * a->h_inverse[i]);
    return fmin((part > 0 ? part : 1) * simulation->time_step, simulation->scheme.cfl / sqrt(pull));
}

/* Finds the particle that limits the time step. */
static ptrdiff_t limiting_particle(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    ptrdiff_t limiting = 0;
    simulation->plan.sums->signal(simulation);
    for (ptrdiff_t i = 1; i < a->n; i++)
        if (a->h[i] * a->signal[limiting] < a->h[limiting] * a->signal[i]) limiting = i;
    return limiting;
}

double simulation_time_after(const struct simulation *simulation, double dt)
{
    return dt >= simulation->t_end - simulation->time ? simulation->t_end : simulation->time + dt;
}

/* The last step is shortened to end at t_end exactly, and the last two are made equal. */
double simulation_next_step(const struct simulation *simulation, double time)
{
    const double left = simulation->t_end - time;
    const double dt = simulation->dt > 0 ? simulation->time_step : first_time_step(simulation);
    if (dt >= left) return fmax(left, 0);
    return 2 * dt > left ? 0.5 * left : dt;
}

/* Energy is conserved to the order of the integrator; a change by half of it is an instability.
 * Runs with fixed layers are not checked, because these exchange energy with the moving gas. */
static enum status check_energy(const struct simulation *simulation, struct error *error)
{
    struct conservation sums;
    if (simulation->held) return STATUS_OK;
    conservation_sums(simulation, &sums);
    if (fabs(sums.energy - simulation->start_energy) <= 0.5 * simulation->start_energy)
        return STATUS_OK;
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: total energy is %.9g, at the start it was %.9g",
                     simulation->time, sums.energy, simulation->start_energy);
}

/* Takes one step. STATUS_BROKE_DOWN: the state is the last valid one. */
static enum status advance(struct simulation *simulation, struct error *error)
{
    double dt = simulation_next_step(simulation, simulation->time);
    simulation->largest_dt = fmax(simulation->largest_dt, dt);
    if (simulation->plan.local)
        dt = steps_begin_block(simulation, dt, simulation->t_end - simulation->time);
    const bool local = simulation->plan.local && !simulation->steps.single;
    const bool last = simulation_time_after(simulation, dt) >= simulation->t_end;
    /* the last step may be arbitrarily short */
    if (!last && collapsed(simulation, dt))
        return breakdown_of(simulation, limiting_particle(simulation), "collapsed time step", dt,
                            error);
    simulation->dt_before = simulation->dt;
    simulation->dt = dt;
    const enum status status = local ? steps_block(simulation, dt, error)
                                     : simulation->scheme.integrator->step(simulation, dt, error);
    if (status) return status;
    if (simulation->plan.jump) simulation->plan.sums->apply_switch(simulation, dt);
    simulation->time = simulation_time_after(simulation, dt);
    if (simulation->plan.signal_pass && simulation->time < simulation->t_end)
        evaluate_signal(simulation);
    if (!local)
        simulation->plan.sums->sleep_update(simulation); /* creates new ranges without a reach */
    struct simulation_cost *cost = &simulation->cost;
    const uint64_t steps = local ? 1u << simulation->steps.depth : 1;
    const uint64_t all = steps * (uint64_t)simulation->particles.n;
    const uint64_t done =
        local ? simulation->steps.updates : (uint64_t)simulation->sleep.awake_count;
    cost->steps += steps;
    cost->particle_updates += done;
    cost->skipped_particle_updates += all > done ? all - done : 0;
    if (check_work(simulation, error)) return error->status;
    const bool look = simulation->scheme.energy == ENERGY_INTERNAL && cost->steps % 128 == 0;
    return look ? check_energy(simulation, error) : STATUS_OK;
}

enum status simulation_run(struct simulation *simulation, double t_end,
                           simulation_progress *progress, void *context, struct error *error)
{
    const struct integrator *integrator = simulation->scheme.integrator;
    enum status status = STATUS_OK;
    bool stopped = false;
    simulation->t_end = t_end;
    team_pause(&simulation->team);
    while (simulation->time < t_end && !stopped && !status) {
        status = advance(simulation, error);
        if (simulation->team.most > 1) team_step(&simulation->team, wall_seconds());
        if (!status && progress)
            stopped = !progress(context, simulation->time, simulation->cost.steps);
    }
    if (integrator->synchronise) integrator->synchronise(simulation);
    if (!status && !integrator->ends_evaluated) status = evaluate_state(simulation, error);
    if (!status) status = check_energy(simulation, error);
    stop_clocks(simulation);
    return status;
}

void simulation_serialise(struct simulation *simulation, struct serialiser *serialiser)
{
    struct sleep *sleep = &simulation->sleep;
    stop_clocks(simulation);
    particles_serialise(&simulation->particles, serialiser);
    SERIALISE(serialiser, simulation->time);
    SERIALISE(serialiser, simulation->time_step);
    SERIALISE(serialiser, simulation->dt);
    SERIALISE(serialiser, simulation->dt_before);
    SERIALISE(serialiser, simulation->largest_dt);
    SERIALISE(serialiser, simulation->start_energy);
    SERIALISE(serialiser, simulation->cost);
    SERIALISE(serialiser, simulation->steps);
    SERIALISE(serialiser, sleep->on);
    SERIALISE(serialiser, sleep->at_rest);
    SERIALISE(serialiser, sleep->rate);
    SERIALISE(serialiser, sleep->sound);
    SERIALISE(serialiser, sleep->tolerance);
    SERIALISE(serialiser, sleep->span_count);
    SERIALISE(serialiser, sleep->awake_count);
    serialise(serialiser, sleep->spans, (size_t)sleep->span_count * sizeof *sleep->spans);
    serialise(serialiser, simulation->integrator_state, simulation->scheme.integrator->keeps);
    simulation->plan.sums->serialise(simulation, serialiser);
    if (!serialiser->back) return;
    simulation->wall_start = wall_seconds() - simulation->cost.wall_s;
    simulation->cpu_start = cpu_seconds() - simulation->cost.cpu_s;
}
