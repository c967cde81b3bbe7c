/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sums of a simulation in 2D and 3D: passes the fields of its particles to cells. */
#include <math.h>

#include "specialise.h"
#include "state.h"
#include "workspace.h"

static enum status reserve(struct simulation *simulation, struct error *error)
{
    (void)simulation;
    (void)error;
    return STATUS_OK;
}

/* f_i = (|div v| + eps c/h)/(|div v| + |curl v| + (eps + 1e-4) c/h) (Balsara 1995). */
static void find_balsara(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    double *const *L = workspace->fields.slope;
    const double floor_of = simulation->scheme.balsara_floor;
#pragma omp parallel for num_threads(simulation->team.size) if (simulation->team.size > 1)
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
        rate = largest(rate, state_rate(a, first, workspace_batch(a, first)));
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
    simulation->cost.without_conductivity += left_out.conductivity;
    for (ptrdiff_t first = 0; simulation->plan.alpha && first < a->n; first += BATCH_MAX)
        state_dalpha(a, first, workspace_batch(a, first), &simulation->scheme);
    sleep_balance(simulation);
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

const struct sums cells_sums = {
    .name = "cells",
    .dim_min = 2,
    .dim_max = 3,
    .create = workspace_create,
    .free = workspace_free,
    .bytes = workspace_bytes,
    .begin = workspace_begin,
    .reserve = reserve,
    .arrange = workspace_arrange,
    .widths = workspace_widths,
    .close = workspace_close,
    .matrix = matrix,
    .forces = forces,
    .signal = signal,
    .find_switch = find_switch,
    .apply_switch = apply_switch,
    .describe = describe,
    .sleep_begin = workspace_begin_sleep,
    .sleep_update = workspace_update_sleep,
    .sleeps = workspace_sleeps,
    .end = workspace_end,
    .serialise = workspace_serialise,
};
