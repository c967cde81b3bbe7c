/* SPDX-License-Identifier: GPL-3.0-or-later
 * Quasi-random points with the density of the gas, by rejection in one additional dimension, then
 * relaxed to a glass. */
#include "equal_masses.h"

#include <math.h>

#include "initial.h"
#include "quasi_random.h"
#include "relax.h"

enum { CELLS_PLANE = 512, CELLS_SPACE = 96 }; /* cells per direction for sums over the box */

/* The gas to follow, and the mass of a particle. */
struct gas {
    const struct prepared *p;
    double most; /* upper bound of the density */
    double mass; /* total mass in the box; later the mass of a particle */
};

static double density_at(const struct prepared *p, const double x[3])
{
    struct problem_state state;
    p->problem->sample(p, x, 0, &state);
    return state.rho;
}

/* Mass by the midpoint rule: exact for smooth periodic gas, wrong by a fraction of a cell at a
 * jump. */
static void measure(struct gas *gas)
{
    const struct domain *box = &gas->p->domain;
    const size_t side = box->dim == 2 ? CELLS_PLANE : CELLS_SPACE;
    const size_t cells = box->dim == 2 ? side * side : side * side * side;
    double share = 1. / (double)cells;
    for (int d = 0; d < box->dim; d++) share *= domain_length(box, d);
    for (size_t c = 0; c < cells; c++) {
        const size_t at[3] = {c % side, c / side % side, c / side / side};
        double x[3] = {0};
        for (int d = 0; d < box->dim; d++)
            x[d] = box->lo[d] + domain_length(box, d) * ((double)at[d] + 0.5) / (double)side;
        const double rho = density_at(gas->p, x);
        gas->mass += rho * share;
        gas->most = fmax(gas->most, 1.01 * rho);
    }
}

static enum status throw_points(const struct gas *gas, unsigned long seed, size_t n,
                                double *const x[3], struct error *error)
{
    const struct domain *box = &gas->p->domain;
    struct quasi_random *random = quasi_random_create(box->dim + 1, seed);
    double part[QUASI_RANDOM_DIM_MAX];
    if (!random) return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu points", n);
    for (size_t i = 0; i < n;) {
        double at[3] = {0};
        quasi_random_next(random, part);
        for (int d = 0; d < box->dim; d++) at[d] = box->lo[d] + domain_length(box, d) * part[d];
        if (!(part[box->dim] * gas->most < density_at(gas->p, at))) continue;
        for (int d = 0; d < box->dim; d++) x[d][i] = at[d];
        i++;
    }
    quasi_random_destroy(random);
    return STATUS_OK;
}

static double volume_at(const void *context, const double x[3])
{
    const struct gas *gas = context;
    return gas->mass / density_at(gas->p, x);
}

enum status equal_masses_fill(const struct prepared *p, const struct settings *settings,
                              struct initial *initial, struct error *error)
{
    const size_t n = (size_t)settings_real(settings, SETTING_n);
    struct gas gas = {.p = p};
    measure(&gas);
    gas.mass /= (double)n;
    const struct relax_region region = {p->domain, volume_at, &gas};
    if (initial_allocate(initial, p->domain.dim, n, error) ||
        throw_points(&gas, (unsigned long)settings_real(settings, SETTING_seed), n, initial->x,
                     error) ||
        (settings_choice(settings, SETTING_lattice) == LATTICE_GLASS &&
         relax_points(&region, n, initial->x, error)))
        return error->status;
    for (size_t i = 0; i < n; i++) {
        initial_sample(initial, p, i);
        initial->m[i] = gas.mass;
    }
    return STATUS_OK;
}

enum status equal_masses_check(const struct initial *initial, struct error *error)
{
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < initial->n; i++)
        least = fmin(least, initial->m[i]), most = fmax(most, initial->m[i]);
    if (most <= least * (1 + 1e-9)) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "equal masses: the particles of this case with these keys have masses that "
                     "differ by a factor of %.6g, with numbers of particles near this one too; "
                     "allowed: cases and keys that lay equal ones",
                     most / least);
}
