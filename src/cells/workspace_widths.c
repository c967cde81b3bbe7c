/* SPDX-License-Identifier: GPL-3.0-or-later
 * Neighbours and smoothing lengths of a simulation in 2D and 3D: searches with sufficient radii,
 * the order in memory, smoothing lengths by Newton's method or predicted, and the equation of
 * state. */
#include <math.h>
#include <string.h>

#include "breakdown.h"
#include "fixed.h"
#include "specialise.h"
#include "state.h"
#include "workspace.h"

enum {
    SORT_EVERY = 32, /* steps: gathering slows down as neighbours drift apart in memory */
    TRIES_MAX = 64   /* searches in one evaluation, each with 1.5 times the radius */
};

enum status workspace_arrange(struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    struct workspace *workspace = workspace_of(simulation);
    for (int k = 0; k < a->dim; k++)
        for (ptrdiff_t i = 0; i < a->n; i++)
            if (!isfinite(a->x[k][i]))
                return breakdown_of(simulation, i, "position", a->x[k][i], error);
    if (workspace->cells) {
        cells_team(workspace->cells, simulation->team.size);
        return STATUS_OK;
    }
    /* the box is known only now */
    const struct cells_method method = workspace_method(simulation);
    workspace->cells = cells_create(&method, (size_t)a->n);
    return workspace->cells
               ? STATUS_OK
               : error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", a->n);
}

/* Half of the shortest periodic side; for a larger radius the nearest image is not unique. */
static double half_box(const struct simulation *simulation)
{
    double half = HUGE_VAL;
    for (int k = 0; k < simulation->plan.dim; k++)
        if (simulation->boundary[k] == BOUNDARY_PERIODIC)
            half = least(half, 0.5 * simulation->particles.period[k]);
    return half;
}

/* The role of each particle in the evaluation of a level; NULL: all are active. */
static const unsigned char *find_parts(const struct simulation *simulation)
{
    const struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const double level = simulation->steps.level;
    bool all = true;
    if (level < 0) return workspace->asleep;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        workspace->parts[i] = a->level[i] > level   ? CELLS_SUMMED
                              : a->level[i] < level ? CELLS_RECEIVES
                                                    : CELLS_ACTIVE;
        all &= workspace->parts[i] == CELLS_ACTIVE;
    }
    return all ? NULL : workspace->parts;
}

/* Finds neighbours within the radii. A radius too large for the box is bad input at the start and a
 * breakdown later. */
static enum status search_for(struct simulation *simulation, const unsigned char *parts,
                              struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const enum status status =
        cells_arrange(workspace->cells, &workspace->fields, workspace->radius, parts, error);
    if (status != STATUS_BAD_INPUT || simulation->cost.steps == 0) return status;
    ptrdiff_t widest = 0;
    for (ptrdiff_t i = 1; i < a->n; i++)
        if (!(workspace->radius[i] <= workspace->radius[widest])) widest = i;
    struct error where;
    breakdown_of(simulation, widest, "smoothing length", workspace->radius[widest], &where);
    return error_set(error, STATUS_BROKE_DOWN,
                     "%.400s, beyond half the box (%g): more particles or a smaller eta are needed",
                     where.message, half_box(simulation));
}

static enum status search(struct simulation *simulation, struct error *error)
{
    return search_for(simulation, find_parts(simulation), error);
}

static void permute(struct particles *particles, double *array)
{
    const size_t n = (size_t)particles->n;
    memcpy(particles->spare, array, n * sizeof *array);
    for (size_t i = 0; i < n; i++) array[i] = particles->spare[particles->order[i]];
}

/* Sorts the particles every SORT_EVERY steps so that neighbours are close in memory. */
static void sort_memory(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    struct particles *a = &simulation->particles;
    if (workspace->sorted && simulation->cost.steps < workspace->sorted_at + SORT_EVERY) return;
    const uint32_t *order = grid_order(cells_grid(workspace->cells));
    const size_t slots = cells_points(workspace->cells);
    ptrdiff_t next = 0;
    for (size_t slot = 0; slot < slots; slot++) /* skips images */
        if (order[slot] < (size_t)a->n) a->order[next++] = order[slot];
    /* inactive particles keep the values of their last sums */
    for (size_t k = 0; k < workspace->arrays; k++)
        permute(a, workspace->block + k * workspace->stride);
    if (workspace->asleep) {
        permute(a, workspace->kept);
        for (ptrdiff_t i = 0; i < a->n; i++) workspace->outcome[i] = workspace->asleep[a->order[i]];
        memcpy(workspace->asleep, workspace->outcome, (size_t)a->n);
    }
    particles_permute(a);
    workspace->sorted = true;
    workspace->sorted_at = simulation->cost.steps;
}

static enum status search_sorted(struct simulation *simulation, struct error *error)
{
    const struct workspace *workspace = workspace_of(simulation);
    const bool due =
        !workspace->sorted || simulation->cost.steps >= workspace->sorted_at + SORT_EVERY;
    const enum status status = search(simulation, error);
    if (status || !due) return status;
    sort_memory(simulation);
    return search(simulation, error);
}

static void number_to_mass(const struct simulation *simulation, ptrdiff_t first, int len,
                           struct density_sums *sums)
{
    const double *m = simulation->particles.m + first;
    for (int i = 0; i < len; i++) {
        sums->m[i] *= m[i];
        sums->m_dh[i] *= m[i];
    }
}

/* The equation of state of a batch. Inactive particles keep their predicted values. */
static void close_batch(const struct simulation *simulation, ptrdiff_t first, int len,
                        const struct gas *gas, const struct density_sums *sums)
{
    const struct particles *a = &simulation->particles;
    double *const set[] = {a->h_inverse_found, a->V, a->rho, a->h, a->P, a->c};
    enum { SET = sizeof set / sizeof *set };
    double kept[SET][BATCH_MAX];
    bool all = true, none = true;
    for (ptrdiff_t i = first; i < first + len; i++) {
        const bool evaluated = simulation_evaluates(simulation, i);
        all &= evaluated;
        none &= !evaluated;
    }
    if (none) return;
    for (int k = 0; !all && k < SET; k++)
        memcpy(kept[k], set[k] + first, (size_t)len * sizeof(double));
    state_close(a, first, len, &simulation->plan, gas, sums);
    for (int i = 0; !all && i < len; i++)
        for (int k = 0; !simulation_evaluates(simulation, first + i) && k < SET; k++)
            set[k][first + i] = kept[k][i];
}

/* The equation of state of all particles, from their sums. */
static void close_all(struct simulation *simulation, bool predicted)
{
    const struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const struct scheme *scheme = &simulation->scheme;
    const struct gas gas = {.gamma = simulation->gamma,
                            .constant = scheme->kernel.constant[a->dim],
                            .eta = scheme->eta,
                            .follow = predicted ? scheme->integrator->follow : 0};
    const ptrdiff_t batches = (a->n + BATCH_MAX - 1) / BATCH_MAX;
    const bool number = scheme->volume_element == VOLUME_NUMBER;
#pragma omp parallel for num_threads(simulation->team.size) if (simulation->team.size > 1)
    for (ptrdiff_t b = 0; b < batches; b++) {
        struct density_sums sums;
        const ptrdiff_t first = b * BATCH_MAX;
        const int len = workspace_batch(a, first);
        const size_t bytes = (size_t)len * sizeof(double);
        memcpy(sums.m, workspace->sum_m + first, bytes);
        memcpy(sums.m_dh, workspace->sum_m_dh + first, bytes);
        if (simulation->plan.energy_sum) {
            memcpy(sums.Z, workspace->sum_Z + first, bytes);
            memcpy(sums.Z_dh, workspace->sum_Z_dh + first, bytes);
        }
        if (number) number_to_mass(simulation, first, len, &sums);
        close_batch(simulation, first, len, &gas, &sums);
        /* b = Z P/y^2 with Z = 1 instead of m */
        for (int i = 0; number && simulation->plan.grad_h && i < len; i++)
            a->b[first + i] *= a->m[first + i];
    }
}

/* Solves for h of all particles with outcome CELLS_OPEN; enlarges the search radius where h exceeds
 * it. */
static enum status find_roots(struct simulation *simulation, struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const struct width_rule rule = width_rule_of(simulation);
    const double half = half_box(simulation);
    ptrdiff_t open = 0;
    for (int try = 0; try < TRIES_MAX; try++) {
        cells_widths(workspace->cells, &workspace->fields, &rule, workspace->radius, a->h,
                     a->h_inverse, workspace->outcome);
        bool wider = false;
        for (ptrdiff_t i = 0; i < a->n; i++) {
            if (workspace->outcome[i] == CELLS_NO_ROOT)
                return breakdown_of(simulation, i, "smoothing length (no root was found)", a->h[i],
                                    error);
            if (workspace->outcome[i] != CELLS_WIDER) continue;
            if (!wider) open = i;
            wider = true;
            workspace->outcome[i] = CELLS_OPEN;
            a->h[i] = workspace->radius[i];
            /* tries half the box before a larger radius, which is refused */
            workspace->radius[i] = workspace->radius[i] < half
                                       ? least(1.5 * workspace->radius[i], half)
                                       : 1.5 * workspace->radius[i];
        }
        if (!wider) return STATUS_OK;
        const enum status status = search(simulation, error);
        if (status) return status;
    }
    return breakdown_of(simulation, open, "smoothing length (no root was found)", a->h[open],
                        error);
}

static enum status newton_widths(struct simulation *simulation, struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const double half = half_box(simulation);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->h[i] = least(a->h[i], half); /* a first guess may be anything */
        workspace->radius[i] = least(workspace_margin * a->h[i], half);
    }
    enum status status = search_sorted(simulation, error);
    if (status) return status;
    memset(workspace->outcome, CELLS_OPEN, (size_t)a->n);
    status = find_roots(simulation, error);
    if (!status) close_all(simulation, false);
    return status;
}

static void find_radii(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) workspace_of(simulation)->radius[i] = 1 / a->h_inverse[i];
}

/* Corrects the pairs that change level as particles wake, and ends the steps of these particles. */
static enum status wake(struct simulation *simulation, struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    double spans[STEPS_LEVELS];
    enum status status = STATUS_OK;
    if (steps_uncovered(simulation, spans)) {
        for (size_t i = 0; i < workspace->fields.n; i++)
            workspace->parts[i] = workspace->woken[i] ? CELLS_ACTIVE : CELLS_RECEIVES;
        status = search_for(simulation, workspace->parts, error);
        if (status) return status;
        cells_correct(workspace->cells, &workspace->fields, steps_woken_level(simulation), spans);
        fixed_rates(simulation);
    }
    status = steps_wake(simulation, workspace->woken, error);
    if (status) return status;
    find_radii(simulation);
    return search(simulation, error);
}

/* Wakes neighbours of active particles whose level is too coarse. */
static enum status wake_neighbours(struct simulation *simulation, struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    struct cells_fields *fields = &workspace->fields;
    const int to = steps_woken_level(simulation);
    enum status status = STATUS_OK;
    if (to < STEPS_APART) return STATUS_OK;
    fields->coarsest = to + 1 - STEPS_APART;
    fields->wake_to = (unsigned char)to;
    while (!status) {
        memset(workspace->woken, 0, fields->n);
        cells_find_coarse(workspace->cells, fields);
        if (!memchr(workspace->woken, to, fields->n)) break;
        status = wake(simulation, error);
    }
    return status;
}

static enum status predicted_widths(struct simulation *simulation, double ratio,
                                    struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const bool local = workspace->fields.local = simulation->steps.level >= 0;
    for (ptrdiff_t first = 0; !local && first < a->n; first += BATCH_MAX)
        width_predict(a, first, workspace_batch(a, first), ratio);
    for (ptrdiff_t i = 0; workspace->asleep && i < a->n; i++) {
        if (local) workspace->asleep[i] = 0; /* no particle sleeps during local steps */
        if (workspace->asleep[i]) a->h_inverse[i] = workspace->kept[i];
    }
    find_radii(simulation);
    enum status status = search_sorted(simulation, error);
    if (!status && local) status = wake_neighbours(simulation, error);
    if (status) return status;
    if (local) steps_begin_sums(simulation);
    cells_density(workspace->cells, &workspace->fields);
    close_all(simulation, true);
    return STATUS_OK;
}

enum status workspace_widths(struct simulation *simulation, bool newton, double ratio,
                             struct error *error)
{
    return newton ? newton_widths(simulation, error) : predicted_widths(simulation, ratio, error);
}

void workspace_close(struct simulation *simulation)
{
    close_all(simulation, false);
}
