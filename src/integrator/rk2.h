/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two-register Runge-Kutta stages (Ketcheson 2010, algorithm 3): a stage combines the current
 * state, the state at the start of the step and the rates. With them RK2 (Heun), VL2 and RK3. */
#ifndef INTEGRATOR_RK2_H
#define INTEGRATOR_RK2_H

/* state = g1 state + g2 old + weight dt rates, then the rates of the new state. */
static enum status runge_kutta_stage(struct simulation *simulation, double g1, double g2,
                                     double weight, double dt, struct error *error)
{
    struct particles *a = &simulation->particles;
    const double step = weight * dt;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->x[i] = g1 * a->x[i] + g2 * a->x_old[i] + a->p[i] * a->m_inverse[i] * step;
        a->p[i] = g1 * a->p[i] + g2 * a->p_old[i] + a->F[i] * step;
        a->e[i] = g1 * a->e[i] + g2 * a->e_old[i] + a->de[i] * step;
    }
    if (simulation->plan.alpha)
        for (ptrdiff_t i = 0; i < a->n; i++)
            a->alpha[i] = g1 * a->alpha[i] + g2 * a->alpha_old[i] + a->dalpha[i] * step;
    return evaluate_rates(simulation, error);
}

static void runge_kutta_begin(struct simulation *simulation)
{
    struct particles *a = &simulation->particles;
    const size_t bytes = (size_t)a->n * sizeof(double);
    memcpy(a->x_old, a->x, bytes);
    memcpy(a->p_old, a->p, bytes);
    memcpy(a->e_old, a->e, bytes);
    memcpy(a->alpha_old, a->alpha, bytes);
}

static enum status rk2_step(struct simulation *simulation, double dt, struct error *error)
{
    runge_kutta_begin(simulation);
    const enum status status = runge_kutta_stage(simulation, 0, 1, 1, dt, error);
    return status ? status : runge_kutta_stage(simulation, 0.5, 0.5, 0.5, dt, error);
}

#endif
INTEGRATOR(rk2, .member = {"rk2", "Runge-Kutta, Heun, SSP", "Shu & Osher 1988"}, .order = 2,
           .evaluations = 2, .cfl = 0.3, .ends_evaluated = true)
