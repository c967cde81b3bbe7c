/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "solver.h"

enum { GHOSTS_AT_START = 64 };

/* A time step that is so much shorter than another of the same run will not get it anywhere; nor
 * will a run that has visited so many more pairs than its particles would in steps of that length:
 * they have clumped, and steps have become short, for ever. */
static const double collapse = 1e-9, pairs_at_least = 1e7, pairs_each = 1000;

static bool collapsed(const struct simulation *simulation, double dt)
{
    const double largest = simulation->largest_dt, n = (double)simulation->particles.n;
    return !(dt > collapse * largest && simulation->time + dt > simulation->time) ||
           (double)simulation->cost.pair_interactions >
               pairs_at_least + pairs_each * n * simulation->t_end / largest;
}

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum status check_scene(const struct scene *scene, struct error *error)
{
    if (scene->dim != 1)
        return error_set(error, STATUS_BAD_INPUT, "dimension = %d: the solver is for dimension 1",
                         scene->dim);
    if (scene->n < 2)
        return error_set(error, STATUS_BAD_INPUT, "n = %zu: at least 2 particles", scene->n);
    if (!(scene->gamma > 1) || !isfinite(scene->gamma))
        return error_set(error, STATUS_BAD_INPUT, "gamma = %g: must be > 1", scene->gamma);
    const double period = scene->hi[0] - scene->lo[0];
    if (!(period > 0) || !isfinite(period))
        return error_set(error, STATUS_BAD_INPUT, "box [%g, %g]: must have a positive length",
                         scene->lo[0], scene->hi[0]);
    for (size_t i = 0; i < scene->n; i++) {
        if (!(scene->x[0][i] >= scene->lo[0] && scene->x[0][i] <= scene->hi[0]))
            return error_set(error, STATUS_BAD_INPUT, "particle %zu: x = %g is outside the box", i,
                             scene->x[0][i]);
        if (!isfinite(scene->v[0][i]))
            return error_set(error, STATUS_BAD_INPUT, "particle %zu: velocity %g", i,
                             scene->v[0][i]);
        if (!(scene->m[i] > 0) || !isfinite(scene->m[i]))
            return error_set(error, STATUS_BAD_INPUT, "particle %zu: mass %g must be > 0", i,
                             scene->m[i]);
        if (!(scene->u[i] > 0) || !isfinite(scene->u[i]))
            return error_set(error, STATUS_BAD_INPUT,
                             "particle %zu: specific internal energy %g must be > 0", i,
                             scene->u[i]);
    }
    return scheme_check(&scene->scheme, scene->dim, error);
}

/* Particles at one place whose own terms alone exceed what a narrow kernel allows have no root h:
 * they are moved apart by a thousandth of their spacing. Sorted positions. */
static void separate(struct particles *a, const struct scheme *scheme)
{
    const double least_eta = kernel_least_eta(&scheme->kernel, 1);
    for (ptrdiff_t first = 0, end; first < a->n; first = end) {
        for (end = first + 1; end < a->n && a->x[end] == a->x[first];) end++;
        const ptrdiff_t count = end - first;
        if (count == 1 || (double)count * least_eta < scheme->eta) continue;
        const double before = first > 0 ? a->x[first - 1] : a->x[a->n - 1] - a->period;
        const double after = end < a->n ? a->x[end] : a->x[0] + a->period;
        const double room = fmin(a->x[first] - before, after - a->x[first]);
        const double gap = fmin(1e-3 * a->h[first] / scheme->eta, 0.5 * room / (double)count);
        for (ptrdiff_t k = 0; k < count; k++)
            a->x[first + k] += ((double)k - 0.5 * (double)(count - 1)) * gap;
        for (ptrdiff_t i = first; i < end; i++) a->x_old[i] = a->x[i];
    }
}

/* The state of the scene, sorted by position, with a first guess of h. */
static void set_particles(struct simulation *simulation, const struct scene *scene)
{
    struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    double mass = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) mass += scene->m[i];
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double m = scene->m[i], v = scene->v[0][i], u = scene->u[i];
        const double rho = scene->rho && scene->rho[i] > 0 ? scene->rho[i] : mass / a->period;
        a->id[i] = (size_t)i;
        a->x[i] = a->x_old[i] = scene->x[0][i];
        a->m[i] = m;
        a->m_inverse[i] = 1 / m;
        a->p[i] = m * v;
        a->e[i] = m * u + (scheme->energy == ENERGY_TOTAL ? 0.5 * m * v * v : 0);
        a->alpha[i] = a->alpha_old[i] =
            scheme->viscosity == VISCOSITY_TIME_DEPENDENT ? scheme->alpha_min : scheme->alpha;
        a->h[i] = scheme->eta * m / rho;
    }
    particles_sort(a);
    separate(a, scheme);
}

static enum status allocate(struct simulation *simulation, struct error *error)
{
    const ptrdiff_t n = simulation->particles.n;
    /* room for spans of every length, each of which ends in a range that is not full */
    const ptrdiff_t groups = (n + SLEEP_GROUP - 1) / SLEEP_GROUP;
    simulation->range_count = (n + RANGE_MAX - 1) / RANGE_MAX;
    simulation->ranges = calloc((size_t)(groups + 1), sizeof *simulation->ranges);
    simulation->wrapped = malloc((size_t)n * sizeof(double));
    simulation->specific_energy = malloc((size_t)n * sizeof(double));
    if (!simulation->ranges || !simulation->wrapped || !simulation->specific_energy)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
    for (ptrdiff_t b = 0; b < simulation->range_count; b++) {
        struct range *range = &simulation->ranges[b];
        range->first = b * RANGE_MAX;
        range->len = (int)(n - range->first < RANGE_MAX ? n - range->first : RANGE_MAX);
        range->reach = 1;
    }
    return STATUS_OK;
}

enum status simulation_create(const struct scene *scene, struct simulation **result,
                              struct error *error)
{
    *result = NULL;
    enum status status = check_scene(scene, error);
    if (status) return status;
    struct simulation *simulation = calloc(1, sizeof *simulation);
    if (!simulation) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    simulation->wall_start = seconds(CLOCK_MONOTONIC);
    simulation->cpu_start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    simulation->scheme = scene->scheme;
    simulation->plan = plan_make(&scene->scheme, scene->skip);
    loops_choose(&simulation->scheme, !scene->unstamped, &simulation->loops);
    simulation->lo = scene->lo[0];
    simulation->period = scene->hi[0] - scene->lo[0];
    simulation->gamma = scene->gamma;
    simulation->threads = scene->threads > 1 ? scene->threads : 1;
    status = particles_create(&simulation->particles, (ptrdiff_t)scene->n, GHOSTS_AT_START, error);
    if (status) goto failed;
    simulation->particles.period = simulation->period;
    status = allocate(simulation, error);
    if (status) goto failed;
    set_particles(simulation, scene);
    status = evaluate_rates(simulation, error);
    if (status) goto failed;
    struct conservation start;
    simulation_conservation(simulation, &start);
    simulation->start_energy = start.energy;
    status = evaluate_reserve(simulation, error);
    if (status) goto failed;
    status = sleep_begin(simulation, simulation->plan.sleep, error);
    if (status) goto failed;
    *result = simulation;
    return STATUS_OK;
failed:
    simulation_destroy(simulation);
    return status;
}

void simulation_destroy(struct simulation *simulation)
{
    if (!simulation) return;
    particles_destroy(&simulation->particles);
    sleep_free(&simulation->sleep);
    free(simulation->ranges);
    free(simulation->scratch);
    free(simulation->wrapped);
    free(simulation->specific_energy);
    free(simulation);
}

static void stop_clocks(struct simulation *simulation)
{
    simulation->cost.wall_s = seconds(CLOCK_MONOTONIC) - simulation->wall_start;
    simulation->cost.cpu_s = seconds(CLOCK_PROCESS_CPUTIME_ID) - simulation->cpu_start;
}

/* Signal speeds know velocities, and so nothing of light particles at rest beside a high pressure:
 * the first step is no longer than cfl sqrt(h/a): they move a quarter of h. A much
 * shorter one would leave the second, which knows only velocities, too long. */
static double first_time_step(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double part = simulation->scheme.integrator->first_step;
    double pull = 0; /* a/h */
    for (ptrdiff_t i = 0; i < a->n; i++)
        pull = fmax(pull, fabs(a->F[i]) * a->m_inverse[i] * a->h_inverse[i]);
    return fmin((part > 0 ? part : 1) * simulation->time_step, simulation->scheme.cfl / sqrt(pull));
}

/* The particle that limits the time step. */
static ptrdiff_t limiting_particle(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    ptrdiff_t limiting = 0;
    for (ptrdiff_t b = 0; b < simulation->range_count; b++) {
        const struct range *range = &simulation->ranges[b];
        loops_signal(a, range->first, range->len, range->force_reach);
    }
    for (ptrdiff_t i = 1; i < a->n; i++)
        if (a->h[i] * a->signal[limiting] < a->h[limiting] * a->signal[i]) limiting = i;
    return limiting;
}

double simulation_time_after(const struct simulation *simulation, double dt)
{
    return dt >= simulation->t_end - simulation->time ? simulation->t_end : simulation->time + dt;
}

/* t_end is met exactly: the last step is cut, and the last two are made equal. */
double simulation_next_step(const struct simulation *simulation, double time)
{
    const double left = simulation->t_end - time;
    const double dt = simulation->last_dt > 0 ? simulation->time_step : first_time_step(simulation);
    if (dt >= left) return fmax(left, 0);
    return 2 * dt > left ? 0.5 * left : dt;
}

/* Back from the middle of a step that does not follow. */
static void undo_prediction(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    if (simulation->ahead <= 0) return;
    memcpy(a->x, a->x_old, (size_t)a->n * sizeof(double));
    if (simulation->plan.alpha) memcpy(a->alpha, a->alpha_old, (size_t)a->n * sizeof(double));
    simulation->ahead = 0;
}

/* Energy is kept to the order of the integrator; where half of it has come or gone, an instability
 * has run away with it. */
static enum status check_energy(const struct simulation *simulation, struct error *error)
{
    struct conservation sums;
    simulation_conservation(simulation, &sums);
    if (fabs(sums.energy - simulation->start_energy) <= 0.5 * simulation->start_energy)
        return STATUS_OK;
    return error_set(error, STATUS_BROKE_DOWN,
                     "broke down at t = %.9g: total energy is %.9g, at the start it was %.9g",
                     simulation->time, sums.energy, simulation->start_energy);
}

enum status simulation_run(struct simulation *simulation, double t_end,
                           simulation_progress *progress, void *context, struct error *error)
{
    enum status status = STATUS_OK;
    bool stopped = false;
    simulation->t_end = t_end;
    while (simulation->time < t_end && !stopped) {
        const double dt = simulation_next_step(simulation, simulation->time);
        const bool last = simulation_time_after(simulation, dt) >= t_end;
        simulation->largest_dt = fmax(simulation->largest_dt, dt);
        /* in the last step t_end alone decides, however near it is */
        if (!last && collapsed(simulation, dt)) {
            status = broke_down(simulation, limiting_particle(simulation), "collapsed time step",
                                dt, error);
            break;
        }
        /* the interval to the next density sum, against the last one: half a step each side */
        simulation->predict_ratio =
            simulation->last_dt > 0 ? 0.5 * (simulation->last_dt + dt) / simulation->last_dt : 0;
        simulation->last_dt = dt;
        status = simulation->scheme.integrator->step(simulation, dt, error);
        if (status) break;
        simulation->time = simulation_time_after(simulation, dt);
        if (simulation->plan.signal_pass && simulation->time < t_end) evaluate_signal(simulation);
        sleep_update(simulation); /* makes new ranges, of which no reach is known yet */
        simulation->cost.steps++;
        simulation->cost.particle_updates += (uint64_t)simulation->sleep.awake_count;
        simulation->cost.skipped_particle_updates +=
            (uint64_t)(simulation->particles.n - simulation->sleep.awake_count);
        if (simulation->scheme.energy == ENERGY_INTERNAL && simulation->cost.steps % 128 == 0 &&
            (status = check_energy(simulation, error)))
            break;
        if (progress) stopped = !progress(context, simulation->time, simulation->cost.steps);
    }
    undo_prediction(simulation);
    if (!status && !simulation->scheme.integrator->ends_evaluated)
        status = evaluate_state(simulation, error);
    if (!status) status = check_energy(simulation, error);
    stop_clocks(simulation);
    return status;
}

void simulation_snapshot(const struct simulation *simulation, struct snapshot *snapshot)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double x = a->x[i] - simulation->lo;
        const double wrapped = x - simulation->period * floor(x / simulation->period);
        simulation->wrapped[i] = simulation->lo + (wrapped < simulation->period ? wrapped : 0);
        simulation->specific_energy[i] = a->U[i] * a->m_inverse[i];
    }
    *snapshot = (struct snapshot){
        .n = (size_t)a->n,
        .x = {simulation->wrapped},
        .v = {a->v},
        .m = a->m,
        .rho = a->rho,
        .u = simulation->specific_energy,
        .P = a->P,
        .h = a->h,
        .volume = a->V,
        .id = a->id,
        .time = simulation->time,
    };
}

void simulation_rates(const struct simulation *simulation, struct rates *rates)
{
    const struct particles *a = &simulation->particles;
    *rates = (struct rates){.force = {a->F},
                            .energy = a->de,
                            .alpha = simulation->plan.alpha ? a->dalpha : NULL,
                            .time_step = simulation->time_step};
}

void simulation_conservation(const struct simulation *simulation, struct conservation *sums)
{
    const struct particles *a = &simulation->particles;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    /* long double: the sums themselves shall not be what is measured */
    long double mass = 0, momentum = 0, momentum_scale = 0, sound = 0, energy = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const long double p = a->p[i];
        mass += a->m[i];
        momentum += p;
        momentum_scale += fabsl(p);
        sound += (long double)a->m[i] * a->c[i];
        energy += a->e[i];
        if (!total) energy += 0.5L * p * p / a->m[i];
    }
    *sums = (struct conservation){
        .mass = (double)mass,
        .momentum = {(double)momentum},
        .momentum_scale = (double)momentum_scale,
        .sound_scale = (double)sound,
        .energy = (double)energy,
    };
}

void simulation_cost(const struct simulation *simulation, struct simulation_cost *cost)
{
    *cost = simulation->cost;
}
