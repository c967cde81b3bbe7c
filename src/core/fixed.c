/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fixed.h"

#include <math.h>
#include <stdlib.h>

#include "solver.h"
#include "width.h"

/* In place of a density: the particle is fixed, but its density comes from its own sum. */
#define HELD_BY_ITS_SUMS (-1.)

/* Distance from the nearest fixed end, in smoothing lengths. */
static double from_end(const struct simulation *simulation, ptrdiff_t i)
{
    const struct particles *a = &simulation->particles;
    double least = HUGE_VAL;
    for (int k = 0; k < a->dim; k++) {
        if (simulation->boundary[k] != BOUNDARY_FIXED) continue;
        const double from_lo = a->x[k][i] - simulation->lo[k];
        least = fmin(least, fmin(from_lo, a->period[k] - from_lo) / a->h[i]);
    }
    return least;
}

enum status fixed_begin(struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    bool fixed = false;
    for (int k = 0; k < a->dim; k++) fixed |= simulation->boundary[k] == BOUNDARY_FIXED;
    if (!fixed) return STATUS_OK;
    simulation->held = calloc((size_t)a->n, sizeof *simulation->held);
    if (!simulation->held)
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %td particles", a->n);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double depth = from_end(simulation, i);
        if (!(depth < 3)) continue;
        /* h = eta (m/rho)^(1/d) */
        const double side = a->h[i] / simulation->scheme.eta;
        simulation->held[a->id[i]] = depth < 1 ? a->m[i] / pow(side, a->dim) : HELD_BY_ITS_SUMS;
        for (int k = 0; k < a->dim; k++) {
            if (simulation->scheme.energy == ENERGY_TOTAL)
                a->e[i] -= 0.5 * a->p[k][i] * a->p[k][i] * a->m_inverse[i];
            a->p[k][i] = 0;
        }
    }
    return STATUS_OK;
}

void fixed_state(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double *held = simulation->held;
    const double gamma = simulation->gamma;
    const enum volume_element element = simulation->scheme.volume_element;
    const struct width_rule rule = {.dim = a->dim, .eta = simulation->scheme.eta};
    for (ptrdiff_t i = 0; held && i < a->n; i++) {
        const double rho = held[a->id[i]];
        if (!(rho > 0)) continue;
        const double u = a->U[i] * a->m_inverse[i];
        a->rho[i] = rho;
        a->V[i] = a->m[i] / rho;
        a->P[i] = (gamma - 1) * rho * u;
        a->c[i] = sqrt(gamma * (gamma - 1) * u);
        a->h[i] = width_of(&rule, a->m[i], rho);
        a->h_inverse[i] = a->h_inverse_found[i] = 1 / a->h[i];
        if (!simulation->plan.newton) a->h_inverse_old[i] = a->h_inverse[i];
        const double Z = element == VOLUME_NUMBER   ? 1
                         : element == VOLUME_ENERGY ? a->U[i]
                                                    : a->m[i];
        if (simulation->plan.grad_h) a->b[i] = a->P[i] * (a->V[i] * a->V[i] / Z);
        if (simulation->plan.own_gradient)
            a->g[i] = simulation->scheme.kernel.constant[a->dim] / pow(a->h[i], a->dim + 1);
    }
}

void fixed_rates(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const double *held = simulation->held;
    for (ptrdiff_t i = 0; held && i < a->n; i++) {
        if (held[a->id[i]] == 0) continue;
        for (int k = 0; k < a->dim; k++) a->F[k][i] = 0;
        a->de[i] = a->dalpha[i] = 0;
        if (!simulation->plan.local) continue;
        for (int k = 0; k < a->dim; k++) a->impulse[k][i] = 0;
        a->heat[i] = 0;
    }
}

void fixed_free(struct simulation *simulation)
{
    free(simulation->held);
}
