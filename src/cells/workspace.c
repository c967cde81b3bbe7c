/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "workspace.h"

#include <stdlib.h>

#include "sleep.h"
#include "width.h"

struct cells_method workspace_method(const struct simulation *simulation)
{
    const struct plan *plan = &simulation->plan;
    struct cells_method method = cells_method_of(&simulation->scheme, plan);
    method.still = plan->quiet && !plan->jump ? 0.01 * sleep_least_tolerance(simulation) : 0;
    method.threads = simulation->team.most;
    for (int k = 0; k < plan->dim; k++) {
        method.box.lo[k] = simulation->lo[k];
        method.box.hi[k] = simulation->lo[k] + simulation->particles.period[k];
        method.box.periodic[k] = simulation->boundary[k] == BOUNDARY_PERIODIC;
        method.wall[k] = simulation->boundary[k] == BOUNDARY_REFLECTING;
    }
    return method;
}

enum { ARRAYS_MAX = 12 + 2 * (CELLS_SYMMETRIC + CELLS_SQUARE) };

/* Lists the arrays that a workspace needs for the scheme. Returns their number. */
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
    if (gradient_of[simulation->scheme.gradient].share) of[count++] = &workspace->fields.steep;
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

/* Allocates the arrays, n doubles each, in one block. */
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

/* Connects the fields of the sums to the particles' arrays, which never move: there are no ghosts.
 */
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
        fields->shift[k] = a->shift[k];
        fields->potential[k] = a->potential[k];
        fields->dp_shift[k] = a->dp_shift[k];
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
    fields->dm = a->dm;
    fields->de_shift = a->de_shift;
    fields->div_v = a->div_v;
    fields->signal = a->signal;
}

enum status workspace_create(struct simulation *simulation, ptrdiff_t n, struct error *error)
{
    struct workspace *workspace = simulation->workspace = calloc(1, sizeof *workspace);
    if (!workspace || !allocate_arrays(simulation, (size_t)n))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", n);
    /* loops in whole vectors read beyond the ends */
    return particles_create(&simulation->particles, simulation->plan.dim, n, 8, error);
}

double workspace_bytes(const struct simulation *simulation, double n)
{
    struct workspace workspace = {0};
    double **of[ARRAYS_MAX];
    const struct cells_method method = workspace_method(simulation);
    const double arrays = (double)list_arrays(simulation, &workspace, of);
    /* the first search has a margin; lists hold all pairs within the larger h */
    const double neighbours =
        width_neighbours(method.box.dim, simulation->scheme.eta * workspace_margin);
    /* outcome; parts and woken; with sleep: asleep and three arrays */
    const double sleepers = simulation->plan.sleep ? 3 * sizeof(double) + 1 : 0,
                 local = simulation->plan.local ? 2 : 0;
    return n * (arrays * sizeof(double) + 1 + local + sleepers) +
           cells_bytes(&method, n, neighbours);
}

void workspace_forget_sleep(struct workspace *workspace)
{
    free(workspace->asleep);
    free(workspace->disturbance);
    free(workspace->arriving);
    free(workspace->kept);
    workspace->asleep = NULL;
    workspace->disturbance = workspace->arriving = NULL;
    workspace->kept = NULL;
}

void workspace_free(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    if (!workspace) return;
    cells_destroy(workspace->cells);
    free(workspace->block);
    free(workspace->outcome);
    free(workspace->parts);
    workspace_forget_sleep(workspace);
    free(workspace);
}

void workspace_begin(struct simulation *simulation)
{
    connect_fields(simulation);
}

void workspace_end(struct simulation *simulation)
{
    struct workspace *workspace = workspace_of(simulation);
    cells_destroy(workspace->cells);
    workspace->cells = NULL;
}

/* Neighbour lists are not saved: every evaluation finds them anew. */
void workspace_serialise(struct simulation *simulation, struct serialiser *serialiser)
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
