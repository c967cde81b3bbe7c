/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In 1D particles start in the (periodic) order of their numbers. Counts those whose right
 * neighbour is no longer the next one. */
static size_t count_crossed(const struct snapshot *snapshot)
{
    size_t crossed = 0;
    for (size_t i = 0; snapshot->id && i < snapshot->n; i++)
        crossed += snapshot->id[(i + 1) % snapshot->n] != (snapshot->id[i] + 1) % snapshot->n;
    return crossed;
}

/* Copies a field in the order of positions: particles that have crossed the periodic end are moved
 * to the other end. */
static void copy_line(const struct snapshot *seen, const double *from, double *to)
{
    size_t first = 0;
    for (size_t i = 1; i < seen->n; i++)
        if (seen->x[0][i] < seen->x[0][i - 1]) first = i;
    memcpy(to, from + first, (seen->n - first) * sizeof(double));
    memcpy(to + seen->n - first, from, first * sizeof(double));
}

/* Copies a field in the order of the particle numbers, which is the initial order. */
static void copy_cloud(const struct snapshot *seen, const double *from, double *to)
{
    for (size_t i = 0; i < seen->n; i++) to[seen->id[i]] = from[i];
}

enum status run_keep(struct run_result *result, const struct snapshot *snapshot,
                     struct error *error)
{
    const struct snapshot seen = *snapshot;
    struct snapshot *kept = &result->snapshot;
    const struct domain *domain = &result->problem.domain;
    const double *from[12];
    const double **to[12];
    size_t arrays = 0;
    for (int d = 0; d < domain->dim; d++) {
        from[arrays] = seen.x[d], to[arrays++] = &kept->x[d];
        from[arrays] = seen.v[d], to[arrays++] = &kept->v[d];
    }
    const double *const scalars[] = {seen.m, seen.rho, seen.u, seen.P, seen.h, seen.volume};
    const double **const targets[] = {&kept->m, &kept->rho, &kept->u,
                                      &kept->P, &kept->h,   &kept->volume};
    for (size_t k = 0; k < sizeof scalars / sizeof *scalars; k++)
        from[arrays] = scalars[k], to[arrays++] = targets[k];
    result->storage = malloc(arrays * seen.n * sizeof(double));
    if (!result->storage) return error_set(error, STATUS_ENVIRONMENT, "no memory for a snapshot");
    for (size_t i = 0; i < arrays; i++) {
        double *copy = result->storage + i * seen.n;
        (domain->dim == 1 ? copy_line : copy_cloud)(&seen, from[i], copy);
        *to[i] = copy;
    }
    kept->n = seen.n;
    result->crossed = domain->dim == 1 ? count_crossed(snapshot) : 0;
    result->spacing = domain_spacing(domain, seen.n);
    kept->time = result->time = seen.time;
    return STATUS_OK;
}

void run_free(struct run_result *result)
{
    free(result->storage);
    result->storage = NULL;
    result->snapshot = (struct snapshot){0};
}
