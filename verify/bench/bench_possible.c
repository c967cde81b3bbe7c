/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_possible.h"

#include <math.h>
#include <stdlib.h>

#include "initial.h"
#include "initial_create.h"

static const double reaches = 3;

struct counting {
    const struct prepared *problem;
    const struct initial *initial;
    double *h; /* of the start, by id */
    double share;
    uint64_t steps;
};

/* Gas ahead of all waves moves on as it started. */
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

static bool count(void *context, double time, uint64_t steps)
{
    struct counting *counting = context;
    const struct prepared *p = counting->problem;
    size_t ahead = 0;
    for (size_t i = 0; i < counting->initial->n; i++) {
        double x[3] = {0};
        place_at(counting, i, time, x);
        ahead += p->problem->ahead(p, x, time) > reaches * counting->h[i];
    }
    counting->share += (double)ahead / (double)counting->initial->n;
    counting->steps = steps;
    return true;
}

static enum status run_counting(const struct run *run, struct counting *counting,
                                struct bench_shares *shares, struct error *error)
{
    const struct scene scene = run_scene(run, counting->initial);
    struct simulation *simulation = NULL;
    struct simulation_cost cost;
    struct snapshot start;
    enum status status = simulation_create(&scene, &simulation, error);
    if (status) return status;
    simulation_snapshot(simulation, &start);
    for (size_t i = 0; i < start.n; i++) counting->h[start.id[i]] = start.h[i];
    const bool known = run->problem.problem->ahead != NULL;
    status = simulation_run(simulation, scene.t_end, known ? count : NULL, counting, error);
    simulation_cost(simulation, &cost);
    simulation_destroy(simulation);
    const double skipped = (double)cost.skipped_particle_updates;
    shares->skipped = skipped / (skipped + (double)cost.particle_updates);
    shares->possible = known ? counting->share / (double)counting->steps : (double)NAN;
    return status;
}

enum status bench_possible(const struct run *run, struct bench_shares *shares, struct error *error)
{
    struct initial initial = {0};
    enum status status = initial_create(&initial, &run->problem, &run->settings, error);
    if (status) return status;
    struct counting counting = {
        .problem = &run->problem, .initial = &initial, .h = malloc(initial.n * sizeof(double))};
    status = counting.h ? run_counting(run, &counting, shares, error)
                        : error_set(error, STATUS_ENVIRONMENT, "no memory");
    free(counting.h);
    initial_free(&initial);
    return status;
}
