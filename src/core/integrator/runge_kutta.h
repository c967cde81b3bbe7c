/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two-register Runge-Kutta stages (Ketcheson 2010, algorithm 3): a stage combines the current
 * state, the state at the start of the step and the rates. RK2 (Heun), VL2 and RK3 consist of such
 * stages. */
#ifndef INTEGRATOR_RUNGE_KUTTA_H
#define INTEGRATOR_RUNGE_KUTTA_H

#include <string.h>

#include "solver.h"

/* Sets state = g1 state + g2 old + step rates, then computes the rates of the new state. */
static inline enum status runge_kutta_stage(struct simulation *simulation, double g1, double g2,
                                            double step, struct error *error)
{
    struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++) {
        double *x = a->x[k], *p = a->p[k];
        const double *x_old = a->x_old[k], *p_old = a->p_old[k], *F = a->F[k];
        for (ptrdiff_t i = 0; i < a->n; i++) {
            x[i] = g1 * x[i] + g2 * x_old[i] + p[i] * a->m_inverse[i] * step;
            p[i] = g1 * p[i] + g2 * p_old[i] + F[i] * step;
        }
    }
    for (ptrdiff_t i = 0; i < a->n; i++)
        a->e[i] = g1 * a->e[i] + g2 * a->e_old[i] + a->de[i] * step;
    if (simulation->plan.alpha)
        for (ptrdiff_t i = 0; i < a->n; i++)
            a->alpha[i] = g1 * a->alpha[i] + g2 * a->alpha_old[i] + a->dalpha[i] * step;
    return evaluate_rates(simulation, error);
}

static inline void runge_kutta_begin(struct simulation *simulation)
{
    struct particles *a = &simulation->particles;
    const size_t bytes = (size_t)a->n * sizeof(double);
    for (int k = 0; k < a->dim; k++) {
        memcpy(a->x_old[k], a->x[k], bytes);
        memcpy(a->p_old[k], a->p[k], bytes);
    }
    memcpy(a->e_old, a->e, bytes);
    memcpy(a->alpha_old, a->alpha, bytes);
}

#endif
