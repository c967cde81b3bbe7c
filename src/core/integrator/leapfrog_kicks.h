/* SPDX-License-Identifier: GPL-3.0-or-later
 * The step of both leapfrogs: half kick, drift, prediction of the rest of the state to the end of
 * the step for the evaluation, then the second half kick from the half-kicked values. */
#ifndef INTEGRATOR_LEAPFROG_KICKS_H
#define INTEGRATOR_LEAPFROG_KICKS_H

#include "solver.h"

/* Writes half-kicked values to *_old and predicted ones to the state. */
static inline void leapfrog_kick_drift(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++) {
        double *x = a->x[k], *p = a->p[k], *p_old = a->p_old[k];
        const double *F = a->F[k];
        for (ptrdiff_t i = 0; i < a->n; i++) {
            p_old[i] = p[i] + F[i] * (0.5 * dt);
            x[i] += p_old[i] * a->m_inverse[i] * dt;
            p[i] += F[i] * dt;
        }
    }
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->e_old[i] = a->e[i] + a->de[i] * (0.5 * dt);
        a->e[i] += a->de[i] * dt;
    }
    if (!simulation->plan.alpha) return;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->alpha_old[i] = a->alpha[i] + a->dalpha[i] * (0.5 * dt);
        a->alpha[i] += a->dalpha[i] * dt;
    }
}

static inline void leapfrog_kick(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++)
        for (ptrdiff_t i = 0; i < a->n; i++) a->p[k][i] = a->p_old[k][i] + a->F[k][i] * (0.5 * dt);
    for (ptrdiff_t i = 0; i < a->n; i++) a->e[i] = a->e_old[i] + a->de[i] * (0.5 * dt);
    if (!simulation->plan.alpha) return;
    for (ptrdiff_t i = 0; i < a->n; i++) a->alpha[i] = a->alpha_old[i] + a->dalpha[i] * (0.5 * dt);
}

static inline enum status leapfrog_kicks(struct simulation *simulation, double dt,
                                         struct error *error)
{
    leapfrog_kick_drift(simulation, dt);
    const enum status status = evaluate_rates(simulation, error);
    if (status == STATUS_OK) leapfrog_kick(simulation, dt);
    return status;
}

#endif
