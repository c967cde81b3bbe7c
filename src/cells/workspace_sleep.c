/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sleep in 2D and 3D: a particle at rest among neighbours at rest is not evaluated until a
 * neighbour wakes it. */
#include <math.h>
#include <stdlib.h>

#include "workspace.h"

/* Computes the disturbance of each particle. Only particles that move with their neighbours may
 * sleep: in a shear flow on a lattice the forces vanish as well, but neighbours change. */
static struct cells_quiet find_quiet(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double found = workspace->asleep[i] ? 0 : sleep_disturbance(simulation, i, 1);
        workspace->disturbance[i] = isnan(found) ? HUGE_VAL : found;
    }
    return (struct cells_quiet){.disturbance = workspace->disturbance,
                                .arriving = workspace->arriving,
                                .tolerance = simulation->sleep.tolerance,
                                .sound = simulation->sleep.sound,
                                .calm = SLEEP_CALM};
}

static void fall_asleep(struct simulation *simulation, const struct cells_quiet *quiet)
{
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    cells_fall_asleep(workspace->cells, &workspace->fields, quiet, workspace->asleep);
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

enum status workspace_begin_sleep(struct simulation *simulation, struct error *error)
{
    struct sleep *sleep = &simulation->sleep;
    struct workspace *workspace = workspace_of(simulation);
    const struct particles *a = &simulation->particles;
    const size_t n = (size_t)a->n;
    /* integrators advance all particles; the rates of sleeping ones are 0 */
    sleep->spans = malloc(sizeof *sleep->spans);
    if (!sleep->spans) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    sleep->spans[0] = (struct span){0, a->n};
    sleep->span_count = 1;
    sleep->awake_count = a->n;
    if (!simulation->plan.sleep) return STATUS_OK;
    workspace->asleep = calloc(n, 1);
    workspace->disturbance = calloc(n, sizeof *workspace->disturbance);
    workspace->arriving = calloc(n, sizeof *workspace->arriving);
    workspace->kept = calloc(n, sizeof *workspace->kept);
    if (!workspace->asleep || !workspace->disturbance || !workspace->arriving || !workspace->kept) {
        workspace_forget_sleep(workspace);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    }
    sleep_scale(simulation);
    const struct cells_quiet quiet = find_quiet(simulation);
    fall_asleep(simulation, &quiet);
    sleep->awake_count = count_awake(workspace, a->n);
    return STATUS_OK;
}

void workspace_update_sleep(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    const ptrdiff_t n = simulation->particles.n;
    const bool due = sleep_due(simulation);
    if (!workspace->asleep || (simulation->sleep.awake_count == n && !due)) return;
    const struct cells_quiet quiet = find_quiet(simulation);
    cells_wake(workspace->cells, &workspace->fields, &quiet, workspace->asleep);
    if (due) fall_asleep(simulation, &quiet);
    simulation->sleep.awake_count = count_awake(workspace, n);
}

bool workspace_sleeps(const struct simulation *simulation, ptrdiff_t i)
{
    const struct workspace *workspace = workspace_of(simulation);
    return workspace->asleep && workspace->asleep[i];
}
