/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_possible.h"

#include <math.h>
#include <stdlib.h>

#include "grid.h"

struct watching {
    struct simulation *simulation;
    double tolerance, sound, heat; /* heat: u/c^2 */
    struct grid *grid;             /* of the initial positions, where unchanged gas still is */
    struct grid_reader reader;
    double *v[3], *rho, *u; /* initial values, by id */
    bool *changed;          /* by id */
    int dim;
    double share; /* summed over steps */
    uint64_t steps;
};

static void find_changed(struct watching *w, const struct snapshot *s)
{
    for (size_t k = 0; k < s->n; k++) {
        const size_t i = s->id[k];
        const double u = fmax(w->u[i], w->heat * w->sound * w->sound), c = sqrt(u / w->heat);
        double square = 0;
        for (int d = 0; d < w->dim; d++)
            square += (s->v[d][k] - w->v[d][i]) * (s->v[d][k] - w->v[d][i]);
        w->changed[i] = sqrt(square) > w->tolerance * c ||
                        fabs(s->rho[k] - w->rho[i]) > w->tolerance * w->rho[i] ||
                        fabs(s->u[k] - w->u[i]) > w->tolerance * u;
    }
}

static bool changed_near(struct watching *w, size_t slot)
{
    const uint32_t *order = grid_order(w->grid);
    const struct grid_list *lists = grid_lists(w->grid);
    if (w->changed[order[slot]]) return true;
    const int32_t *slots = grid_neighbours(w->grid, &w->reader, lists, slot);
    for (int32_t k = 0; k < lists[slot].count; k++)
        if (w->changed[order[slots[k]]]) return true;
    return false;
}

static bool watch(void *context, double time, uint64_t steps)
{
    struct watching *w = context;
    struct snapshot s;
    size_t free = 0;
    (void)time;
    simulation_snapshot(w->simulation, &s);
    find_changed(w, &s);
    for (size_t slot = 0; slot < s.n; slot++) free += !changed_near(w, slot);
    w->share += (double)free / (double)s.n;
    w->steps = steps;
    return true;
}

/* Finds the initial neighbours, by id; in 1D on a line in the plane. values: space for v, rho, u, x
 * and h. */
static enum status begin(struct watching *w, const struct setup *setup, double *values,
                         struct error *error)
{
    struct snapshot s;
    double *x[3], *h = values + 2 * setup->n;
    simulation_snapshot(w->simulation, &s);
    w->rho = values, w->u = values + s.n;
    for (int d = 0; d < 3; d++) {
        w->v[d] = values + (size_t)(3 + d) * s.n;
        x[d] = values + (size_t)(6 + d) * s.n;
    }
    for (size_t k = 0; k < s.n; k++) {
        const size_t i = s.id[k];
        w->rho[i] = s.rho[k], w->u[i] = s.u[k], h[i] = s.h[k];
        for (int d = 0; d < w->dim; d++) w->v[d][i] = s.v[d][k], x[d][i] = s.x[d][k];
    }
    struct grid_box box = {.dim = w->dim < 2 ? 2 : w->dim, .hi = {1, 1, 1}};
    for (int d = 0; d < w->dim; d++) {
        box.lo[d] = setup->lo[d], box.hi[d] = setup->hi[d];
        box.periodic[d] = setup->boundary[d] == BOUNDARY_PERIODIC;
    }
    w->grid = grid_create(&box, s.n, 1);
    if (!w->grid) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    const double *const places[] = {x[0], x[1], x[2]};
    const enum status status = grid_search(w->grid, s.n, s.n, places, h, NULL, error);
    if (!status && !grid_reader_reserve(w->grid, &w->reader))
        return error_set(error, STATUS_ENVIRONMENT, "no memory");
    return status;
}

enum status bench_allowed(const struct run *run, const struct initial *initial, double tolerance,
                          double sound, double *share, struct error *error)
{
    struct setup setup = run_setup(run, initial);
    struct watching w = {.tolerance = tolerance,
                         .sound = sound,
                         .heat = 1 / (setup.gamma * (setup.gamma - 1)),
                         .dim = setup.dim};
    double *values = calloc(9 * setup.n, sizeof *values);
    setup.skip = false;
    w.changed = calloc(setup.n, sizeof *w.changed);
    enum status status = values && w.changed ? simulation_create(&setup, &w.simulation, error)
                                             : error_set(error, STATUS_ENVIRONMENT, "no memory");
    if (!status) status = begin(&w, &setup, values, error);
    if (!status) status = simulation_run(w.simulation, setup.t_end, watch, &w, error);
    *share = w.share / (double)w.steps;
    if (w.simulation) simulation_destroy(w.simulation);
    if (w.grid) grid_destroy(w.grid);
    grid_reader_free(&w.reader);
    free(values), free(w.changed);
    return status;
}
