/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rate_table.h"

#include <math.h>
#include <stdlib.h>

enum { ARRAYS = 7 };

static bool allocate(struct rate_table *table)
{
    const size_t n = table->n;
    double *next = table->storage = calloc(ARRAYS * n, sizeof *next);
    double **const arrays[ARRAYS] = {&table->h,        &table->rho,      &table->P,
                                     &table->force[0], &table->force[1], &table->dU,
                                     &table->force[2]};
    table->described = calloc(n, sizeof *table->described);
    if (!next || !table->described) return false;
    for (int k = 0; k < ARRAYS; k++, next += n) *arrays[k] = next;
    return true;
}

/* Copies the solver's results in the order of the setup; total: the solver integrates E, dE = v . F
 * + dU. */
static void take(struct rate_table *table, const struct simulation *simulation, bool total)
{
    struct snapshot s;
    struct rates rates;
    long double force[3] = {0}, power = 0;
    simulation_snapshot(simulation, &s);
    simulation_rates(simulation, &rates);
    for (size_t k = 0; k < s.n; k++) {
        const size_t i = s.id[k];
        long double work = 0;
        table->h[i] = s.h[k];
        table->rho[i] = s.rho[k];
        table->P[i] = s.P[k];
        for (int a = 0; a < table->dim; a++) {
            table->force[a][i] = rates.force[a][k];
            force[a] += rates.force[a][k];
            work += (long double)s.v[a][k] * rates.force[a][k];
        }
        table->dU[i] = (double)(total ? rates.energy[k] - work : rates.energy[k]);
        power += total ? rates.energy[k] : rates.energy[k] + work;
    }
    for (int a = 0; a < 3; a++) table->sum_force[a] = (double)force[a];
    table->power = (double)power;
}

struct describing {
    struct description *to;
    const size_t *id;
};

static void keep(void *context, size_t particle, const struct description *of)
{
    const struct describing *describing = context;
    describing->to[describing->id[particle]] = *of;
}

static void describe(struct rate_table *table, struct simulation *simulation)
{
    struct snapshot s;
    simulation_snapshot(simulation, &s);
    struct describing describing = {table->described, s.id};
    description_each(simulation, keep, &describing);
    table->matrix = description_sum(simulation);
}

enum status rate_table_make(struct rate_table *table, const struct setup *setup,
                            struct error *error)
{
    *table = (struct rate_table){.dim = setup->dim, .n = setup->n};
    struct simulation *simulation = NULL;
    const enum status status = simulation_create(setup, &simulation, error);
    if (status) return status;
    const bool there = allocate(table);
    if (there) {
        take(table, simulation, setup->scheme.energy == ENERGY_TOTAL);
        describe(table, simulation);
    }
    simulation_destroy(simulation);
    return there ? STATUS_OK
                 : error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", setup->n);
}

void rate_table_free(struct rate_table *table)
{
    free(table->storage);
    free(table->described);
    *table = (struct rate_table){0};
}
