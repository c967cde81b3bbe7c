/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_possible.h"

#include <math.h>
#include <stdlib.h>

#include "solver.h"

static const double reaches = 3;
/* Rates of change, in c per h/c with the setup's mean sound speed, below which gas counts as calm:
 * far above the rate that wakes gas, far below one that changes a run's errors. */
static const double coarse = 1e-7;

struct counting {
    const struct prepared *problem;
    const struct initial *initial;
    struct simulation *simulation;
    double *h;                 /* of the start, by id */
    double *before;            /* v and rho of the step before, by id: dim + 1 runs of n */
    bool *asleep, *free;       /* particles that sleep, and that could: in snapshot order */
    double sound, time, t_end; /* mean of the setup; of the step before; end of the run */
    /* what could be skipped, and what of it was done: summed over steps */
    double share, reached, layers;
    uint64_t steps;
    int columns;
    double slept[BENCH_ROWS][BENCH_COLUMNS], gas[BENCH_ROWS][BENCH_COLUMNS];
};

/* Sound speed if all energy except that of the common motion were heat, as in sleep.h. */
static double setup_sound(const struct initial *initial, int dim, double gamma)
{
    double mass = 0, energy = 0, momentum[3] = {0};
    for (size_t i = 0; i < initial->n; i++) {
        mass += initial->m[i];
        energy += initial->m[i] * initial->u[i];
        for (int k = 0; k < dim; k++) {
            momentum[k] += initial->m[i] * initial->v[k][i];
            energy += 0.5 * initial->m[i] * initial->v[k][i] * initial->v[k][i];
        }
    }
    for (int k = 0; k < dim; k++) energy -= 0.5 * momentum[k] * momentum[k] / mass;
    return sqrt(gamma * (gamma - 1) * fmax(energy, 0) / mass);
}

/* Position of gas ahead of all waves, which keeps its initial velocity. */
static void place_at(const struct counting *counting, size_t i, double time, double x[3])
{
    const struct prepared *p = counting->problem;
    const struct initial *initial = counting->initial;
    for (int d = 0; d < p->domain.dim; d++) {
        const double side = domain_length(&p->domain, d);
        x[d] = initial->x[d][i] + (initial->v[d][i] - p->boost[d]) * time;
        x[d] -= side * floor((x[d] - p->domain.lo[d]) / side);
    }
}

static void find_ahead(const struct counting *counting, const struct snapshot *s, double time)
{
    const struct prepared *p = counting->problem;
    for (size_t i = 0; i < s->n; i++) {
        double x[3] = {0};
        place_at(counting, s->id[i], time, x);
        counting->free[i] = p->problem->ahead(p, x, time) > reaches * counting->h[s->id[i]];
    }
}

/* Marks the particles that change slowly, and keeps all values for the next step. */
static void find_calm(struct counting *counting, const struct snapshot *s, double dt)
{
    const int dim = counting->problem->domain.dim;
    for (size_t i = 0; i < s->n; i++) {
        double *rho = &counting->before[(size_t)dim * s->n + s->id[i]];
        const double slow = coarse * dt * counting->sound / s->h[i]; /* relative */
        double square = 0;
        for (int k = 0; k < dim; k++) {
            double *v = &counting->before[(size_t)k * s->n + s->id[i]];
            square += (s->v[k][i] - *v) * (s->v[k][i] - *v);
            *v = s->v[k][i];
        }
        counting->free[i] =
            sqrt(square) <= slow * counting->sound && fabs(s->rho[i] - *rho) <= slow * *rho;
        *rho = s->rho[i];
    }
}

/* Column of the box along x, from 0. */
static int column_at(const struct counting *counting, double x, int columns)
{
    const struct domain *domain = &counting->problem->domain;
    const double at = (x - domain->lo[0]) / domain_length(domain, 0);
    return (int)fmax(0, fmin(at * columns, columns - 1));
}

/* True if, with this number of columns, an empty one lies between two with particles. */
static bool has_gap(const struct counting *counting, int columns)
{
    const struct initial *initial = counting->initial;
    bool met[BENCH_COLUMNS] = {false};
    int first = columns, last = -1;
    for (size_t i = 0; i < initial->n; i++) {
        const int column = column_at(counting, initial->x[0][i], columns);
        met[column] = true;
        if (column < first) first = column;
        if (column > last) last = column;
    }
    while (first < last && met[first]) first++;
    return first < last;
}

/* The largest number of columns that fits into the map without empty ones at the start between gas:
 * few particles along x would leave stripes. */
static int count_columns(const struct counting *counting)
{
    int columns = BENCH_COLUMNS;
    while (has_gap(counting, columns)) columns--;
    return columns;
}

static void map_sleepers(struct counting *counting, const struct snapshot *s, double time)
{
    const int row = (int)fmin(time / counting->t_end * BENCH_ROWS, BENCH_ROWS - 1);
    for (size_t i = 0; i < s->n; i++) {
        const int column = column_at(counting, s->x[0][i], counting->columns);
        counting->gas[row][column]++;
        counting->slept[row][column] += counting->asleep[i];
    }
}

static void add_shares(struct counting *counting, const struct snapshot *s)
{
    size_t free = 0, reached = 0, layers = 0;
    for (size_t i = 0; i < s->n; i++) {
        if (!counting->free[i]) continue;
        free++;
        if (counting->asleep[i]) continue;
        if (sleep_disturbance(counting->simulation, (ptrdiff_t)i, 1) <= 1)
            layers++;
        else
            reached++;
    }
    counting->share += (double)free / (double)s->n;
    counting->reached += (double)reached / (double)s->n;
    counting->layers += (double)layers / (double)s->n;
}

static bool count(void *context, double time, uint64_t steps)
{
    struct counting *counting = context;
    const bool known = counting->problem->problem->ahead != NULL;
    struct snapshot s;
    simulation_snapshot(counting->simulation, &s);
    if (known)
        find_ahead(counting, &s, time);
    else
        find_calm(counting, &s, time - counting->time);
    simulation_asleep(counting->simulation, counting->asleep);
    add_shares(counting, &s);
    counting->steps = steps;
    counting->time = time;
    map_sleepers(counting, &s, time);
    return true;
}

static bool has_gas(const struct counting *counting, int row)
{
    double gas = 0;
    for (int c = 0; c < counting->columns; c++) gas += counting->gas[row][c];
    return gas > 0;
}

/* Steps may be longer than a row: a row without a step repeats the one before, and the first rows
 * repeat the first one with a step. */
static void fill_map(const struct counting *counting, struct bench_shares *shares)
{
    int from = -1;
    for (int row = 0; row < BENCH_ROWS; row++)
        if (from < 0 && has_gas(counting, row)) from = row;
    for (int row = 0; row < BENCH_ROWS; row++) {
        if (has_gas(counting, row)) from = row;
        for (int c = 0; c < counting->columns; c++)
            shares->asleep[row][c] = counting->slept[from][c] / counting->gas[from][c];
    }
}

static enum status run_counting(const struct run *run, struct counting *counting,
                                struct bench_shares *shares, struct error *error)
{
    const struct setup setup = run_setup(run, counting->initial);
    struct simulation_cost cost;
    struct snapshot start;
    enum status status = simulation_create(&setup, &counting->simulation, error);
    if (status) return status;
    simulation_snapshot(counting->simulation, &start);
    counting->sound = setup_sound(counting->initial, setup.dim, setup.gamma);
    counting->t_end = setup.t_end;
    counting->columns = count_columns(counting);
    for (size_t i = 0; i < start.n; i++) counting->h[start.id[i]] = start.h[i];
    find_calm(counting, &start, 0);
    status = simulation_run(counting->simulation, setup.t_end, count, counting, error);
    simulation_cost(counting->simulation, &cost);
    shares->tolerance = counting->simulation->sleep.tolerance;
    simulation_destroy(counting->simulation);
    const double skipped = (double)cost.skipped_particle_updates;
    shares->skipped = skipped / (skipped + (double)cost.particle_updates);
    shares->possible = counting->share / (double)counting->steps;
    shares->reached = counting->reached / (double)counting->steps;
    shares->layers = counting->layers / (double)counting->steps;
    shares->spacing = run->problem.domain.dim == 1 ? 1 / (double)start.n : 0;
    shares->coarse = run->problem.problem->ahead == NULL;
    shares->columns = counting->columns;
    fill_map(counting, shares);
    shares->allowed = (double)NAN;
    if (status || shares->tolerance <= 0) return status;
    return bench_allowed(run, counting->initial, shares->tolerance, counting->sound,
                         &shares->allowed, error);
}

bool bench_shares_enough(const struct bench_shares *shares)
{
    /* With few particles in 1D most of the rest is layers, up to `spacings` spacings thick. They
     * excuse at most as much work as is skipped, so that sleep that fails is noticed. */
    const double spacings = 40, thickest = fmin(spacings * shares->spacing, shares->skipped);
    const double explained = fmin(shares->layers, thickest);
    return !(shares->skipped + explained < 0.8 * shares->allowed - 0.02);
}

enum status bench_possible(const struct run *run, struct bench_shares *shares, struct error *error)
{
    struct initial initial = {0};
    enum status status = initial_create(&initial, &run->problem, &run->settings, error);
    if (status) return status;
    const size_t values = (size_t)run->problem.domain.dim + 1;
    struct counting *counting = calloc(1, sizeof *counting);
    double *kept = calloc((values + 1) * initial.n, sizeof *kept);
    bool *asleep = calloc(2 * initial.n, sizeof *asleep);
    if (counting && kept && asleep) {
        *counting = (struct counting){.problem = &run->problem,
                                      .initial = &initial,
                                      .h = kept,
                                      .before = kept + initial.n,
                                      .asleep = asleep,
                                      .free = asleep + initial.n};
        status = run_counting(run, counting, shares, error);
    } else {
        status = error_set(error, STATUS_ENVIRONMENT, "no memory");
    }
    free(counting), free(kept), free(asleep);
    initial_free(&initial);
    return status;
}
