/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

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

/* Brings every second particle of a line close to its neighbour on the same side of the jump. */
static void pair_up(struct initial *initial, const struct settings *settings)
{
    const int lattice = settings_choice(settings, SETTING_lattice);
    if (lattice == LATTICE_UNIFORM) return;
    const double part = lattice == LATTICE_CLUSTERED ? 0.05 : 0;
    double *x = initial->x[0];
    for (size_t i = 0; i + 1 < initial->n; i++) {
        if (initial->rho[i] != initial->rho[i + 1] || initial->m[i] != initial->m[i + 1]) continue;
        const double middle = 0.5 * (x[i] + x[i + 1]), half = part * (x[i + 1] - x[i]);
        x[i] = middle - half;
        x[i + 1] = middle + half;
        i++;
    }
}

bool initial_is_shaken(const struct settings *settings)
{
    return settings_real(settings, SETTING_jitter) > 0;
}

static double spacing(const struct initial *initial, size_t i)
{
    const double volume = initial->m[i] / initial->rho[i];
    return initial->dim == 1 ? volume : initial->dim == 2 ? sqrt(volume) : cbrt(volume);
}

/* Moves each particle in each direction by up to jitter times its share of the space: on a line
 * their order stays. */
static enum status shake(struct initial *initial, const struct domain *domain,
                         const struct settings *settings)
{
    const double jitter = settings_real(settings, SETTING_jitter);
    if (!initial_is_shaken(settings)) return STATUS_OK;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (!random) return STATUS_ENVIRONMENT;
    gsl_rng_set(random, (unsigned long)settings_real(settings, SETTING_seed));
    for (size_t i = 0; i < initial->n; i++)
        for (int d = 0; d < initial->dim; d++) {
            double *x = &initial->x[d][i];
            *x += jitter * spacing(initial, i) * (2 * gsl_rng_uniform(random) - 1);
            *x = fmin(fmax(*x, domain->lo[d]), nextafter(domain->hi[d], domain->lo[d]));
        }
    gsl_rng_free(random);
    return STATUS_OK;
}

enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error)
{
    *initial = (struct initial){0};
    const enum status status = p->problem->fill(p, settings, initial, error);
    if (status) {
        initial_free(initial);
        return status;
    }
    pair_up(initial, settings);
    if (shake(initial, &p->domain, settings)) {
        initial_free(initial);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for random numbers");
    }
    return STATUS_OK;
}

void initial_free(struct initial *initial)
{
    free(initial->storage);
    *initial = (struct initial){0};
}
