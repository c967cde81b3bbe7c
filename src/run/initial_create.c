/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "initial.h"

#include <gsl/gsl_rng.h>
#include <math.h>

#include "particle_file.h"
#include "problem.h"

/* Moves particles of a line pairwise together, unless a jump separates the pair. */
static void pair_up(struct initial *initial, const struct prepared *p,
                    const struct settings *settings)
{
    const int lattice = settings_choice(settings, SETTING_lattice);
    if (lattice != LATTICE_CLUSTERED && lattice != LATTICE_COINCIDENT) return;
    const double part = lattice == LATTICE_CLUSTERED ? 0.05 : 0;
    double *x = initial->x[0];
    for (size_t i = 0; i + 1 < initial->n; i++) {
        if (initial->m[i] != initial->m[i + 1]) continue;
        if (!p->problem->smooth && initial->rho[i] != initial->rho[i + 1]) continue;
        const double middle = 0.5 * (x[i] + x[i + 1]), half = part * (x[i + 1] - x[i]);
        x[i] = middle - half;
        x[i + 1] = middle + half;
        i++;
    }
}

static double spacing(const struct initial *initial, size_t i)
{
    const double volume = initial->m[i] / initial->rho[i];
    return initial->dim == 1 ? volume : initial->dim == 2 ? sqrt(volume) : cbrt(volume);
}

/* Maps x into a periodic box, or reflects it at an end that is not periodic. */
static double into_box(const struct prepared *p, int d, double x)
{
    const double lo = p->domain.lo[d], hi = p->domain.hi[d];
    const bool periodic = p->boundary[d] == BOUNDARY_PERIODIC;
    if (x < lo) return periodic ? x + (hi - lo) : lo + (lo - x);
    if (x >= hi) return periodic ? x - (hi - lo) : hi - (x - hi);
    return x;
}

/* Displaces each particle in each direction by up to jitter times its spacing, which keeps the
 * order in 1D. */
static enum status shake(struct initial *initial, const struct prepared *p,
                         const struct settings *settings)
{
    const struct domain *domain = &p->domain;
    const double jitter = settings_real(settings, SETTING_jitter);
    if (!(jitter > 0)) return STATUS_OK;
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    if (!random) return STATUS_ENVIRONMENT;
    gsl_rng_set(random, (unsigned long)settings_real(settings, SETTING_seed));
    for (size_t i = 0; i < initial->n; i++)
        for (int d = 0; d < initial->dim; d++) {
            double *x = &initial->x[d][i];
            *x += jitter * spacing(initial, i) * (2 * gsl_rng_uniform(random) - 1);
            if (initial->dim > 1) *x = into_box(p, d, *x);
            *x = fmin(fmax(*x, domain->lo[d]), nextafter(domain->hi[d], domain->lo[d]));
        }
    gsl_rng_free(random);
    return STATUS_OK;
}

static void add_boost(struct initial *initial, const struct prepared *p)
{
    for (int d = 0; d < initial->dim; d++)
        for (size_t i = 0; i < initial->n; i++) initial->v[d][i] += p->boost[d];
}

/* In 2D and 3D a particle displaced by jitter takes the state at its new position: displaced
 * particles, not a noisy gas. In problems with jumps it keeps its state. */
static void resample(struct initial *initial, const struct prepared *p,
                     const struct settings *settings)
{
    if (initial->dim == 1) return;
    for (size_t i = 0; i < initial->n; i++)
        if (p->problem->smooth && settings_real(settings, SETTING_jitter) > 0)
            initial_sample(initial, p, i);
    add_boost(initial, p);
}

enum status initial_create(struct initial *initial, const struct prepared *p,
                           const struct settings *settings, struct error *error)
{
    *initial = (struct initial){0};
    const char *file = settings->file;
    const enum status status = *file ? particle_file_start(file, p, initial, error)
                                     : p->problem->fill(p, settings, initial, error);
    if (status) {
        initial_free(initial);
        return status;
    }
    if (*file) {
        add_boost(initial, p);
        return STATUS_OK;
    }
    pair_up(initial, p, settings);
    if (shake(initial, p, settings)) {
        initial_free(initial);
        return error_set(error, STATUS_ENVIRONMENT, "no memory for random numbers");
    }
    resample(initial, p, settings);
    return STATUS_OK;
}
