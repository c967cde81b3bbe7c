/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sleep.h"

#include <float.h>
#include <math.h>

#include "solver.h"

enum { DUE_EVERY = 16 /* steps: a look at every particle that is awake */ };

bool sleep_due(const struct simulation *simulation)
{
    return simulation->cost.steps % DUE_EVERY == DUE_EVERY - 1;
}

void sleep_scale(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double gamma = simulation->gamma;
    const bool total = simulation->scheme.energy == ENERGY_TOTAL;
    double mass = 0, energy = 0, momentum[3] = {0};
    for (ptrdiff_t i = 0; i < a->n; i++) {
        mass += a->m[i];
        energy += a->e[i];
        for (int k = 0; k < a->dim; k++) {
            momentum[k] += a->p[k][i];
            if (!total) energy += 0.5 * a->p[k][i] * a->p[k][i] * a->m_inverse[i];
        }
    }
    for (int k = 0; k < a->dim; k++) energy -= 0.5 * momentum[k] * momentum[k] / mass;
    simulation->sleep.sound = energy > 0 ? sqrt(gamma * (gamma - 1) * energy / mass) : 0;
}

/* Positions of order 1 are known to eps, spacings to n^(1/d) eps. */
double sleep_tolerance(const struct simulation *simulation)
{
    const double n = (double)simulation->particles.n;
    const double across = simulation->plan.dim == 1 ? n : pow(n, 1. / simulation->plan.dim);
    return fmax(1e-11, 30 * DBL_EPSILON * across);
}

double sleep_disturbance(const struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    const double sound = simulation->sleep.sound, in_tolerances = 1 / sleep_tolerance(simulation);
    double worst = 0;
    for (ptrdiff_t i = first; i < first + len; i++) {
        const double c = a->c[i] < sound ? sound : a->c[i]; /* NaN stays */
        const double rate = c / a->h[i], force = a->m[i] * c * rate;
        const double rates[3] = {
            particles_norm(a, a->F, i) / force,
            fabs(a->de[i]) / (force * (c + particles_norm(a, a->v, i))),
            simulation->plan.alpha ? fabs(a->dalpha[i]) / rate : 0,
        };
        for (int k = 0; k < 3; k++)
            if (!(rates[k] <= worst || isnan(worst))) worst = rates[k];
    }
    return worst * in_tolerances;
}

void sleep_begin(struct simulation *simulation, ptrdiff_t first, ptrdiff_t len)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = first; i < first + len; i++) {
        a->de[i] = a->dalpha[i] = 0;
        for (int k = 0; k < a->dim; k++) {
            a->F[k][i] = 0;
            simulation->sleep.at_rest &= a->p[k][i] == 0;
        }
    }
}
