/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sums of a simulation in 2D and 3D: its particles' fields handed to cells. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "breakdown.h"
#include "cells.h"
#include "fixed.h"
#include "solver.h"
#include "specialise.h"
#include "state.h"
#include "traits.h"
#include "width.h"

enum {
    SORT_EVERY = 32, /* steps: particles that move on apart in memory slow the gathering down */
    TRIES_MAX = 64   /* searches of one evaluation, each 1.5 times as far */
};

/* How far beyond a first guess the search for a root may go without a second search. */
static const double margin = 1.1;

struct workspace {
    struct cells *cells;
    struct cells_fields fields;
    double *block; /* what the workspace's own arrays live in */
    double *radius, *balsara, *balsara_before;
    double *sum_m, *sum_m_dh, *sum_Z, *sum_Z_dh;
    size_t arrays, stride; /* that lie in block, and from one to the next */
    unsigned char *outcome;
    unsigned char *level;  /* of particles that sleep or may: enum in cells.h; likewise */
    unsigned char *parts;  /* local steps: of each particle, in the evaluation of a level; */
    unsigned char *woken;  /* and the level that it wakes to, 0: none */
    unsigned char *asleep; /* of each particle; NULL: no particle ever sleeps */
    double *kept;          /* 1/h of particles that sleep; likewise */
    uint64_t sorted_at;    /* steps */
    bool sorted;
};

static int batch_len(const struct particles *particles, ptrdiff_t first)
{
    return (int)(particles->n - first < BATCH_MAX ? particles->n - first : BATCH_MAX);
}

static struct workspace *workspace_of(const struct simulation *simulation)
{
    return simulation->workspace;
}

static struct cells_method method_of(const struct simulation *simulation)
{
    const struct scheme *scheme = &simulation->scheme;
    const struct plan *plan = &simulation->plan;
    const bool projected = traits_viscosity[scheme->viscosity].noise;
    const bool varies = plan->alpha || plan->jump;
    struct cells_method method = {
        .box.dim = plan->dim,
        .kernel = &scheme->kernel,
        .specialised = plan->specialised,
        .gradient = scheme->gradient,
        .formulation = scheme->formulation,
        .pair_width = scheme->pair_width,
        .energy = scheme->energy,
        .energy_element = plan->energy_sum,
        .number = scheme->volume_element == VOLUME_NUMBER,
        .viscosity = projected ? VISCOSITY_RECONSTRUCTED
                     : varies  ? VISCOSITY_TIME_DEPENDENT
                               : scheme->viscosity,
        .signal_form = projected || scheme->viscosity_form == VISCOSITY_FORM_SIGNAL,
        .projected = projected,
        .balsara = plan->balsara,
        .velocity_gradient = plan->slope,
        .div_v = plan->alpha,
        .conductivity = scheme->alpha_u,
        .noise = scheme->noise,
        .worst_condition = DESCRIPTION_CONDITION,
        .local = plan->local,
        .jump = plan->jump,
        .alpha_min = scheme->alpha_min,
        .alpha_max = scheme->alpha_max,
        .numbers = {.alpha = scheme->alpha,
                    .beta = scheme->beta,
                    .beta_ratio = scheme->alpha > 0 ? scheme->beta / scheme->alpha : 2,
                    .near = 1 / scheme->eta},
        .still = plan->quiet && !plan->jump ? 0.01 * sleep_tolerance(simulation) : 0,
        .threads = simulation->team.most,
    };
    for (int k = 0; k < plan->dim; k++) {
        method.box.lo[k] = simulation->lo[k];
        method.box.hi[k] = simulation->lo[k] + simulation->particles.period[k];
        method.box.periodic[k] = simulation->boundary[k] == BOUNDARY_PERIODIC;
        method.wall[k] = simulation->boundary[k] == BOUNDARY_REFLECTING;
    }
    return method;
}

/* --- memory ----------------------------------------------------------------------------------- */

enum { ARRAYS_MAX = 12 + 2 * (CELLS_SYMMETRIC + CELLS_SQUARE) };

/* The arrays that a workspace has for the scheme. */
static size_t list_arrays(const struct simulation *simulation, struct workspace *workspace,
                          double **of[ARRAYS_MAX])
{
    const struct plan *plan = &simulation->plan;
    const size_t dim = (size_t)plan->dim, symmetric = dim * (dim + 1) / 2;
    size_t count = 0;
    of[count++] = &workspace->radius;
    of[count++] = &workspace->sum_m;
    of[count++] = &workspace->sum_m_dh;
    if (plan->energy_sum) of[count++] = &workspace->sum_Z, of[count++] = &workspace->sum_Z_dh;
    if (plan->balsara) of[count++] = &workspace->balsara;
    if (plan->matrix) of[count++] = &workspace->fields.condition;
    if (traits_gradient[simulation->scheme.gradient].blends) of[count++] = &workspace->fields.steep;
    for (size_t k = 0; plan->matrix && k < symmetric; k++)
        of[count++] = &workspace->fields.matrix[k];
    for (size_t k = 0; plan->slope && k < dim * dim; k++) of[count++] = &workspace->fields.slope[k];
    if (plan->local && plan->balsara) of[count++] = &workspace->balsara_before;
    for (size_t k = 0; plan->local && plan->matrix && k < symmetric; k++)
        of[count++] = &workspace->fields.matrix_before[k];
    for (size_t k = 0; plan->local && plan->slope && k < dim * dim; k++)
        of[count++] = &workspace->fields.slope_before[k];
    if (plan->jump)
        of[count++] = &workspace->fields.alpha_local, of[count++] = &workspace->fields.decay;
    return count;
}

/* A run of n doubles each, behind each other. */
static bool allocate_arrays(struct simulation *simulation, size_t n)
{
    struct workspace *workspace = workspace_of(simulation);
    double **of[ARRAYS_MAX];
    const size_t count = list_arrays(simulation, workspace, of);
    const size_t stride = workspace->stride = (n + BATCH_MAX + 7) / 8 * 8;
    workspace->arrays = count;
    workspace->block = calloc(count * stride, sizeof(double));
    workspace->outcome = calloc(n, 1);
    workspace->parts = simulation->plan.local ? calloc(n, 2) : NULL;
    workspace->woken = workspace->parts ? workspace->parts + n : NULL;
    workspace->fields.woken = workspace->woken;
    if (!workspace->block || !workspace->outcome) return false;
    if (simulation->plan.local && !workspace->parts) return false;
    for (size_t k = 0; k < count; k++) *of[k] = workspace->block + k * stride;
    return true;
}

/* What the sums read and write of the particles. Their arrays stay where they are: there are no
 * ghosts to grow. */
static void connect_fields(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    struct cells_fields *fields = &workspace->fields;
    fields->n = (size_t)a->n;
    for (int k = 0; k < a->dim; k++) {
        fields->x[k] = a->x[k];
        fields->v[k] = a->v[k];
        fields->F[k] = a->F[k];
        fields->impulse[k] = a->impulse[k];
    }
    fields->heat = a->heat;
    fields->level = a->level;
    fields->pace = a->pace;
    fields->near_pace = a->near_pace;
    fields->m = a->m;
    fields->U = a->U;
    fields->alpha = a->alpha;
    fields->balsara = workspace->balsara;
    fields->balsara_before = workspace->balsara_before;
    fields->ratio = a->ratio;
    fields->h_inverse = a->h_inverse;
    fields->P = a->P;
    fields->c = a->c;
    fields->rho = a->rho;
    fields->V = a->V;
    fields->b = a->b;
    fields->grad_h = a->grad_h;
    fields->sum_m = workspace->sum_m;
    fields->sum_m_dh = workspace->sum_m_dh;
    fields->sum_Z = workspace->sum_Z;
    fields->sum_Z_dh = workspace->sum_Z_dh;
    fields->de = a->de;
    fields->div_v = a->div_v;
    fields->signal = a->signal;
}

static enum status create(struct simulation *simulation, ptrdiff_t n, struct error *error)
{
    struct workspace *workspace = simulation->workspace = calloc(1, sizeof *workspace);
    if (!workspace || !allocate_arrays(simulation, (size_t)n))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
    /* loops in whole vectors read a little beyond the ends */
    return particles_create(&simulation->particles, simulation->plan.dim, n, 8, error);
}

static double bytes(const struct simulation *simulation, double n)
{
    struct workspace workspace = {0};
    double **of[ARRAYS_MAX];
    const struct cells_method method = method_of(simulation);
    const double arrays = (double)list_arrays(simulation, &workspace, of);
    /* the first search goes further, and lists hold who is within the wider of two widths */
    const double neighbours = width_neighbours(method.box.dim, simulation->scheme.eta * margin);
    /* outcome; parts and woken; where particles may sleep, kept, asleep and level */
    const double sleepers = simulation->plan.sleep ? sizeof(double) + 2 : 0,
                 local = simulation->plan.local ? 2 : 0;
    return n * (arrays * sizeof(double) + 1 + local + sleepers) +
           cells_bytes(&method, n, neighbours);
}

static void forget_sleep(struct workspace *workspace)
{
    free(workspace->asleep);
    free(workspace->level);
    free(workspace->kept);
    workspace->asleep = workspace->level = NULL;
    workspace->kept = NULL;
}

static void free_workspace(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    if (!workspace) return;
    cells_destroy(workspace->cells);
    free(workspace->block);
    free(workspace->outcome);
    free(workspace->parts);
    forget_sleep(workspace);
    free(workspace);
}

static void begin(struct simulation *simulation)
{
    connect_fields(simulation);
}

static void end(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    cells_destroy(workspace->cells);
    workspace->cells = NULL;
}

static enum status reserve(struct simulation *simulation, struct error *error)
{
    (void)simulation;
    (void)error;
    return STATUS_OK;
}

/* --- neighbours and widths -------------------------------------------------------------------- */

static enum status arrange(struct simulation *simulation, struct error *error)
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
    /* the box is known by now */
    const struct cells_method method = method_of(simulation);
    workspace->cells = cells_create(&method, (size_t)a->n);
    return workspace->cells
               ? STATUS_OK
               : error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", a->n);
}

/* Beyond half of the narrowest periodic side pairs have no single nearest image. */
static double half_box(const struct simulation *simulation)
{
    double half = HUGE_VAL;
    for (int k = 0; k < simulation->plan.dim; k++)
        if (simulation->boundary[k] == BOUNDARY_PERIODIC)
            half = least(half, 0.5 * simulation->particles.period[k]);
    return half;
}

/* Which particles take part in the evaluation of a level; NULL: all. */
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

/* Finds neighbours within the radii. What is too wide for the box is bad input at the start and a
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

/* Particles that are near each other in space become so in memory, now and then. */
static void sort_memory(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    struct particles *a = &simulation->particles;
    if (workspace->sorted && simulation->cost.steps < workspace->sorted_at + SORT_EVERY) return;
    const uint32_t *order = grid_order(cells_grid(workspace->cells));
    const size_t slots = cells_points(workspace->cells);
    ptrdiff_t place = 0;
    for (size_t slot = 0; slot < slots; slot++) /* images own no storage */
        if (order[slot] < (size_t)a->n) a->order[place++] = order[slot];
    /* those who sleep keep what the last sums over them left */
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

/* The equation of state of a batch. Those who are not being evaluated keep what was predicted. */
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
        const int len = batch_len(a, first);
        const size_t bytes = (size_t)len * sizeof(double);
        memcpy(sums.m, workspace->sum_m + first, bytes);
        memcpy(sums.m_dh, workspace->sum_m_dh + first, bytes);
        if (simulation->plan.energy_sum) {
            memcpy(sums.Z, workspace->sum_Z + first, bytes);
            memcpy(sums.Z_dh, workspace->sum_Z_dh + first, bytes);
        }
        if (number) number_to_mass(simulation, first, len, &sums);
        close_batch(simulation, first, len, &gas, &sums);
        /* b = Z P/y^2 with Z = 1, not m */
        for (int i = 0; number && simulation->plan.grad_h && i < len; i++)
            a->b[first + i] *= a->m[first + i];
    }
}

/* Looks for the roots of all particles that are open, searching further where one lies beyond. */
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
            /* half of the box is searched before more of it is refused */
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
        workspace->radius[i] = least(margin * a->h[i], half);
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

/* Corrects the pairs that leave a level as particles wake, and ends these particles' steps. */
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

/* Neighbours of active particles that are too coarse wake. */
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
        width_predict(a, first, batch_len(a, first), ratio);
    for (ptrdiff_t i = 0; workspace->asleep && i < a->n; i++) {
        if (local) workspace->asleep[i] = 0; /* no particle sleeps where most have long steps */
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

static enum status widths(struct simulation *simulation, bool newton, double ratio,
                          struct error *error)
{
    return newton ? newton_widths(simulation, error) : predicted_widths(simulation, ratio, error);
}

/* --- matrices and forces ---------------------------------------------------------------------- */

/* f_i = (|div v| + eps c/h)/(|div v| + |curl v| + (eps + 1e-4) c/h) (Balsara 1995). */
static void find_balsara(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    double *const *L = workspace->fields.slope;
    const double floor_of = simulation->scheme.balsara_floor;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if (!simulation_evaluates(simulation, i)) continue;
        const double rate = a->c[i] * a->h_inverse[i];
        double div = 0, curl2 = 0;
        for (int k = 0; k < a->dim; k++) {
            div += L[k * a->dim + k][i];
            for (int l = 0; l < k; l++) {
                const double turn = L[k * a->dim + l][i] - L[l * a->dim + k][i];
                curl2 += turn * turn;
            }
        }
        div = fabs(div);
        if (workspace->fields.local) workspace->balsara_before[i] = workspace->balsara[i];
        workspace->balsara[i] =
            (div + floor_of * rate) / (div + sqrt(curl2) + (floor_of + 1e-4) * rate);
    }
}

static void matrix(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const uint64_t fallen_back = cells_matrix(workspace->cells, &workspace->fields);
    simulation->cost.fallen_back += fallen_back;
    if (fallen_back > simulation->cost.fallen_back_most)
        simulation->cost.fallen_back_most = fallen_back;
    if (simulation->plan.balsara) find_balsara(simulation);
}

static double rate_of_all(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    double rate = 0;
    for (ptrdiff_t first = 0; first < a->n; first += BATCH_MAX)
        rate = largest(rate, state_rate(a, first, batch_len(a, first)));
    return rate;
}

static enum status forces(struct simulation *simulation, double *rate, struct error *error)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    (void)error;
    workspace->fields.span = simulation->steps.span;
    simulation->cost.pair_interactions += cells_forces(workspace->cells, &workspace->fields);
    const struct cells_left_out left_out = cells_left_out(workspace->cells);
    simulation->cost.without_viscosity += left_out.viscosity;
    simulation->cost.without_slope += left_out.slope;
    for (ptrdiff_t first = 0; simulation->plan.alpha && first < a->n; first += BATCH_MAX)
        state_dalpha(a, first, batch_len(a, first), &simulation->scheme);
    *rate = rate_of_all(simulation);
    return STATUS_OK;
}

static void find_switch(struct simulation *simulation)
{
    const struct workspace *workspace = workspace_of(simulation);
    cells_switch(workspace->cells, &workspace->fields);
}

static void apply_switch(struct simulation *simulation, double dt)
{
    const struct cells_fields *fields = &workspace_of(simulation)->fields;
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double above = a->alpha[i] - fields->alpha_local[i];
        a->alpha[i] =
            fields->alpha_local[i] + (above > 0 ? above / (1 + dt * fields->decay[i]) : 0);
    }
}

static double signal(struct simulation *simulation)
{
    const struct workspace *workspace = workspace_of(simulation);
    cells_signal(workspace->cells, &workspace->fields);
    return rate_of_all(simulation);
}

static void describe(const struct simulation *simulation, description_visit *visit, void *context)
{
    const struct workspace *workspace = workspace_of(simulation);
    cells_describe(workspace->cells, &workspace->fields, visit, context);
}

/* --- sleep ------------------------------------------------------------------------------------ */

/* Finds the level of each particle. Only particles that move with their neighbours may sleep: in a
 * shear flow on a lattice forces vanish as well, but neighbours change. */
static struct cells_quiet find_quiet(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        workspace->level[i] = CELLS_CALM;
        if (workspace->asleep[i]) continue;
        const double disturbance = sleep_disturbance(simulation, i, 1);
        if (!(disturbance <= SLEEP_CALM)) workspace->level[i] = CELLS_STIRRED;
        if (!(disturbance <= 1)) workspace->level[i] = CELLS_DISTURBED;
        if (!(disturbance <= SLEEP_VIOLENT)) workspace->level[i] = CELLS_VIOLENT;
    }
    return (struct cells_quiet){.level = workspace->level,
                                .tolerance = sleep_tolerance(simulation),
                                .sound = simulation->sleep.sound,
                                .calm = SLEEP_CALM};
}

static void lull(struct simulation *simulation, const struct cells_quiet *quiet)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    if (!cells_lull(workspace->cells, &workspace->fields, quiet, workspace->asleep)) return;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if (workspace->asleep[i] != CELLS_JUST_ASLEEP) continue;
        workspace->asleep[i] = CELLS_ASLEEP;
        workspace->kept[i] = a->h_inverse[i];
        sleep_begin(simulation, i, 1);
    }
}

static ptrdiff_t count_awake(const struct workspace *workspace, ptrdiff_t n)
{
    ptrdiff_t awake = n;
    for (ptrdiff_t i = 0; workspace->asleep && i < n; i++) awake -= workspace->asleep[i];
    return awake;
}

static enum status begin_sleep(struct simulation *simulation, struct error *error)
{
    struct sleep *sleep = &simulation->sleep;
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const size_t n = (size_t)a->n;
    /* integrators advance all particles: the rates of sleeping ones are 0 */
    sleep->spans = malloc(sizeof *sleep->spans);
    if (!sleep->spans) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    sleep->spans[0] = (struct span){0, a->n};
    sleep->span_count = 1;
    sleep->awake_count = a->n;
    if (!simulation->plan.sleep) return STATUS_OK;
    workspace->asleep = calloc(n, 1);
    workspace->level = calloc(n, 1);
    workspace->kept = calloc(n, sizeof *workspace->kept);
    if (!workspace->asleep || !workspace->level || !workspace->kept) {
        forget_sleep(workspace);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    }
    sleep_scale(simulation);
    const struct cells_quiet quiet = find_quiet(simulation);
    lull(simulation, &quiet);
    sleep->awake_count = count_awake(workspace, a->n);
    return STATUS_OK;
}

static void update_sleep(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const ptrdiff_t n = simulation->particles.n;
    const bool due = sleep_due(simulation);
    if (!workspace->asleep || (simulation->sleep.awake_count == n && !due)) return;
    const struct cells_quiet quiet = find_quiet(simulation);
    cells_wake(workspace->cells, &workspace->fields, &quiet, workspace->asleep);
    if (due) lull(simulation, &quiet);
    simulation->sleep.awake_count = count_awake(workspace, n);
}

static bool sleeps(const struct simulation *simulation, ptrdiff_t i)
{
    const struct workspace *workspace = workspace_of(simulation);
    return workspace->asleep && workspace->asleep[i];
}

/* Neighbours are found anew in every evaluation. */
static void serialise_workspace(struct simulation *simulation, struct serialiser *serialiser)
{
    struct workspace *workspace = workspace_of(simulation);
    serialise(serialiser, workspace->block,
              workspace->arrays * workspace->stride * sizeof *workspace->block);
    if (workspace->asleep) {
        const size_t n = (size_t)simulation->particles.n;
        serialise(serialiser, workspace->asleep, n);
        serialise(serialiser, workspace->kept, n * sizeof *workspace->kept);
    }
    SERIALISE(serialiser, workspace->sorted_at);
    SERIALISE(serialiser, workspace->sorted);
}

const struct sums cells_sums = {
    .name = "cells",
    .dim_min = 2,
    .dim_max = 3,
    .create = create,
    .free = free_workspace,
    .bytes = bytes,
    .begin = begin,
    .reserve = reserve,
    .arrange = arrange,
    .widths = widths,
    .matrix = matrix,
    .forces = forces,
    .signal = signal,
    .find_switch = find_switch,
    .apply_switch = apply_switch,
    .describe = describe,
    .sleep_begin = begin_sleep,
    .sleep_update = update_sleep,
    .sleeps = sleeps,
    .end = end,
    .serialise = serialise_workspace,
};
