/* SPDX-License-Identifier: GPL-3.0-or-later
 * Symplectic Euler: kick, then drift with the new momentum. First order. Its measured limits are
 * cfl 0.246 (cubic, eta 2) and 0.287 (eta 4.8): the default stays below both. */
#ifndef INTEGRATOR_SYMPLECTIC_EULER_H
#define INTEGRATOR_SYMPLECTIC_EULER_H

#include "solver.h"

static enum status symplectic_euler_step(struct simulation *simulation, double dt,
                                         struct error *error)
{
    struct particles *a = &simulation->particles;
    for (int k = 0; k < a->dim; k++) {
        double *x = a->x[k], *p = a->p[k];
        const double *F = a->F[k];
        for (ptrdiff_t i = 0; i < a->n; i++) {
            p[i] += F[i] * dt;
            x[i] += p[i] * a->m_inverse[i] * dt;
        }
    }
    for (ptrdiff_t i = 0; i < a->n; i++) a->e[i] += a->de[i] * dt;
    if (simulation->plan.alpha)
        for (ptrdiff_t i = 0; i < a->n; i++) a->alpha[i] += a->dalpha[i] * dt;
    return evaluate_rates(simulation, error);
}

#endif
INTEGRATOR(symplectic_euler,
           .member = {"symplectic_euler", "symplectic Euler, first order", "Ruth 1983"}, .order = 1,
           .evaluations = 1, .cfl = 0.2, .ends_evaluated = true)
