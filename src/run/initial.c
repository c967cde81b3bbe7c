/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <stdlib.h>

#include "lattice.h"
#include "problem.h"

enum status initial_allocate(struct initial *initial, int dim, size_t n, struct error *error)
{
    const size_t arrays = 2 * (size_t)dim + 3;
    double *next = malloc(arrays * n * sizeof(double));
    if (!next) return error_set(error, STATUS_ENVIRONMENT, "no memory for n=%zu particles", n);
    *initial = (struct initial){.dim = dim, .n = n, .storage = next};
    for (int d = 0; d < dim; d++, next += n) initial->x[d] = next;
    for (int d = 0; d < dim; d++, next += n) initial->v[d] = next;
    initial->m = next;
    initial->u = next + n;
    initial->rho = next + 2 * n;
    return STATUS_OK;
}

void initial_sample(struct initial *initial, const struct prepared *p, size_t i)
{
    struct problem_state state;
    double x[3] = {0};
    for (int d = 0; d < initial->dim; d++) x[d] = initial->x[d][i];
    p->problem->sample(p, x, 0, &state);
    for (int d = 0; d < initial->dim; d++) initial->v[d][i] = state.v[d];
    initial->u[i] = state.u;
    initial->rho[i] = state.rho;
}

enum status initial_lay(struct initial *initial, const struct prepared *p,
                        const struct lattice_plan *plan, size_t first,
                        const struct settings *settings, struct error *error)
{
    double *x[3] = {NULL}, share = 1. / (double)plan->n;
    for (int d = 0; d < initial->dim; d++) {
        x[d] = initial->x[d] + first;
        share *= domain_length(&plan->box, d);
    }
    if (lattice_points(plan, (unsigned long)settings_real(settings, SETTING_seed), x, error))
        return error->status;
    for (size_t i = first; i < first + plan->n; i++) {
        initial_sample(initial, p, i);
        initial->m[i] = initial->rho[i] * share;
    }
    return STATUS_OK;
}

void initial_keep(struct initial *initial, size_t first, initial_wanted *wanted,
                  const void *context)
{
    size_t kept = first;
    for (size_t i = first; i < initial->n; i++) {
        double x[3] = {0};
        for (int d = 0; d < initial->dim; d++) x[d] = initial->x[d][i];
        if (!wanted(context, x)) continue;
        for (int d = 0; d < initial->dim; d++) {
            initial->x[d][kept] = x[d];
            initial->v[d][kept] = initial->v[d][i];
        }
        initial->m[kept] = initial->m[i];
        initial->u[kept] = initial->u[i];
        initial->rho[kept++] = initial->rho[i];
    }
    initial->n = kept;
}

void initial_free(struct initial *initial)
{
    free(initial->storage);
    *initial = (struct initial){0};
}
