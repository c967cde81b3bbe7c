/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "autopsy_state.h"

#include <math.h>
#include <stdlib.h>

#include "initial.h"
#include "matrix.h"
#include "rate_table.h"
#include "viscosity.h"

/* ---- power ---- */

static void switch_off(struct scheme *scheme, enum autopsy_term term)
{
    if (term == AUTOPSY_VISCOUS) scheme->viscosity = VISCOSITY_NONE;
    if (term == AUTOPSY_NOISE) scheme->noise = 0;
    if (term == AUTOPSY_CONDUCTIVITY) scheme->alpha_u = scheme->shock_conductivity = 0;
}

static bool has(const struct scheme *scheme, enum autopsy_term term)
{
    if (term == AUTOPSY_CONDUCTIVITY) return scheme_conducts(scheme);
    if (term == AUTOPSY_NOISE) return viscosity_of[scheme->viscosity].noise && scheme->noise > 0;
    return term == AUTOPSY_PRESSURE || !viscosity_of[scheme->viscosity].none;
}

/* Power of the difference of two evaluations; less NULL: of the first one. */
static struct autopsy_power exchanged(const struct snapshot *s, const struct rate_table *table,
                                      const struct rate_table *less)
{
    double work = 0, heat = 0, scale = 0;
    for (size_t i = 0; i < s->n; i++) {
        double own = 0;
        for (int d = 0; d < table->dim; d++)
            own += s->v[d][i] * (table->force[d][i] - (less ? less->force[d][i] : 0));
        const double warmed = table->dU[i] - (less ? less->dU[i] : 0);
        work += own;
        heat += warmed;
        scale += fabs(own) + fabs(warmed);
    }
    return (struct autopsy_power){work, heat, scale};
}

/* Removes the terms one after the other until pressure is left, so that the powers add up to the
 * total. */
enum status autopsy_power(const struct run *run, const struct snapshot *state,
                          struct autopsy_power power[AUTOPSY_TERMS], struct error *error)
{
    const struct initial initial = {
        .n = state->n,
        .x = {(double *)state->x[0], (double *)state->x[1], (double *)state->x[2]},
        .v = {(double *)state->v[0], (double *)state->v[1], (double *)state->v[2]},
        .m = (double *)state->m,
        .u = (double *)state->u};
    struct setup setup = run_setup(run, &initial);
    struct rate_table with = {0}, without = {0};
    setup.skip = false;
    enum status status = rate_table_make(&with, &setup, error);
    for (int term = AUTOPSY_TERMS - 1; !status && term >= 0; term--) {
        power[term] = (struct autopsy_power){0};
        if (!has(&run->scheme, (enum autopsy_term)term)) continue;
        if (term == AUTOPSY_PRESSURE) {
            power[term] = exchanged(state, &with, NULL);
            break;
        }
        switch_off(&setup.scheme, (enum autopsy_term)term);
        status = rate_table_make(&without, &setup, error);
        if (!status) power[term] = exchanged(state, &with, &without);
        rate_table_free(&with);
        with = without;
        without = (struct rate_table){0};
    }
    rate_table_free(&with);
    return status;
}

/* ---- smooth fields and noise ---- */

/* Sums over a cell: of 1, x, x x and, for the fields, f, f x, f f; x relative to the first
 * particle. */
struct autopsy_cell {
    size_t n;
    double weight, origin[3], x[3], xx[3][3], f[3], fx[3][3], squares;
    double aim[3]; /* mean error of the velocity */
};

static size_t place_of(const struct autopsy_cells *cells, size_t i)
{
    const struct domain *domain = &cells->problem->domain;
    size_t place = 0;
    for (int d = domain->dim - 1; d >= 0; d--) {
        const double part = (cells->x[d][i] - domain->lo[d]) / domain_length(domain, d);
        const double k = floor(part * (double)cells->along[d]);
        place = place * cells->along[d] + (size_t)fmin(fmax(k, 0), (double)(cells->along[d] - 1));
    }
    return place;
}

enum status autopsy_cells_make(struct autopsy_cells *cells, const struct prepared *problem,
                               size_t n, double *const x[3], double *weight, struct error *error)
{
    const struct domain *domain = &problem->domain;
    double volume = 1;
    *cells = (struct autopsy_cells){
        .problem = problem, .n = n, .along = {1, 1, 1}, .count = 1, .x = x, .weight = weight};
    for (int d = 0; d < domain->dim; d++) volume *= domain_length(domain, d);
    const double width =
        (domain->dim == 1 ? 2 : 1) * AUTOPSY_CELL * pow(volume / (double)n, 1. / domain->dim);
    for (int d = 0; d < domain->dim; d++) {
        cells->along[d] = (size_t)fmax(1, domain_length(domain, d) / width);
        cells->count *= cells->along[d];
    }
    cells->place = malloc(n * sizeof *cells->place);
    cells->of = calloc(cells->count, sizeof *cells->of);
    if (!cells->place || !cells->of)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    for (size_t i = 0; i < n; i++) cells->place[i] = place_of(cells, i);
    return STATUS_OK;
}

void autopsy_cells_free(struct autopsy_cells *cells)
{
    free(cells->place);
    free(cells->of);
    *cells = (struct autopsy_cells){0};
}

static void add(const struct autopsy_cells *cells, size_t i, double *const a[3], double *const b[3])
{
    struct autopsy_cell *cell = &cells->of[cells->place[i]];
    const double weight = cells->weight[i];
    const int dim = cells->problem->domain.dim;
    if (!(weight > 0)) return;
    for (int d = 0; d < dim && !cell->n; d++) cell->origin[d] = cells->x[d][i];
    cell->n++;
    cell->weight += weight;
    for (int d = 0; d < dim; d++) {
        const double f = a[d][i] - (b ? b[d][i] : 0);
        const double x = cells->x[d][i] - cell->origin[d];
        cell->x[d] += weight * x;
        cell->f[d] += weight * f;
        cell->squares += weight * f * f;
        for (int e = 0; e < dim; e++) {
            cell->xx[d][e] += weight * x * (cells->x[e][i] - cell->origin[e]);
            cell->fx[d][e] += weight * f * (cells->x[e][i] - cell->origin[e]);
        }
    }
}

/* Sum of squares about the best linear function, corrected for its fitted parameters. Too few
 * particles give 0. */
static double scattered(const struct autopsy_cell *cell, int dim)
{
    double about = cell->squares, spread[9] = {0}, inverse[9] = {0};
    const size_t fitted = (size_t)dim + 1;
    if (cell->n <= fitted) return 0;
    for (int d = 0; d < dim; d++)
        for (int e = 0; e < dim; e++)
            spread[d * dim + e] = cell->xx[d][e] - cell->x[d] * cell->x[e] / cell->weight;
    if (!matrix_invert(dim, spread, inverse)) return 0;
    for (int k = 0; k < dim; k++) {
        double slope[3] = {0};
        about -= cell->f[k] * cell->f[k] / cell->weight;
        for (int d = 0; d < dim; d++)
            slope[d] = cell->fx[k][d] - cell->f[k] * cell->x[d] / cell->weight;
        for (int d = 0; d < dim; d++)
            for (int e = 0; e < dim; e++) about -= slope[d] * inverse[d * dim + e] * slope[e];
    }
    return fmax(0, about) * (double)cell->n / (double)(cell->n - fitted);
}

static void sum_up(const struct autopsy_cells *cells, double *const a[3], double *const b[3])
{
    for (size_t k = 0; k < cells->count; k++) {
        struct autopsy_cell *cell = &cells->of[k];
        *cell = (struct autopsy_cell){.aim = {cell->aim[0], cell->aim[1], cell->aim[2]}};
    }
    for (size_t i = 0; i < cells->n; i++) add(cells, i, a, b);
}

void autopsy_cells_aim(struct autopsy_cells *cells, double *const a[3], double *const b[3])
{
    double squares = 0, weight = 0;
    sum_up(cells, a, b);
    for (size_t k = 0; k < cells->count; k++) {
        struct autopsy_cell *cell = &cells->of[k];
        for (int d = 0; d < 3 && cell->weight > 0; d++) {
            cell->aim[d] = cell->f[d] / cell->weight;
            squares += cell->f[d] * cell->aim[d];
        }
        weight += cell->weight;
    }
    cells->aimed = sqrt(squares / weight);
}

struct autopsy_split autopsy_split(const struct autopsy_cells *cells, double *const a[3],
                                   double *const b[3])
{
    double squares = 0, noise = 0, weight = 0, along = 0;
    sum_up(cells, a, b);
    for (size_t k = 0; k < cells->count; k++) {
        const struct autopsy_cell *cell = &cells->of[k];
        squares += cell->squares;
        weight += cell->weight;
        noise += scattered(cell, cells->problem->domain.dim);
        for (int d = 0; d < 3; d++) along += cell->f[d] * cell->aim[d];
    }
    noise = fmin(noise, squares);
    return (struct autopsy_split){sqrt(squares / weight), sqrt(noise / weight),
                                  cells->aimed > 0 ? fabs(along) / weight / cells->aimed
                                                   : sqrt((squares - noise) / weight)};
}
