/* SPDX-License-Identifier: GPL-3.0-or-later
 * Predicted midpoint: the state is predicted to the middle of the step with the rates of the last
 * midpoint, evaluated there once, and advanced over the whole step. Time step 0.8 spacings; 0.9 is
 * weakly unstable where viscosity is off. A predicted internal energy is kept above half of its
 * start (strong tubes); one that turns negative at the end of a step is a breakdown. */
#ifndef INTEGRATOR_PREDICTED_MIDPOINT_H
#define INTEGRATOR_PREDICTED_MIDPOINT_H

CLONES static void predict_midpoint(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    const double half = 0.5 * dt;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict x = a->x, *restrict p = a->p, *restrict e = a->e, *restrict x_old = a->x_old,
                     *restrict p_old = a->p_old, *restrict e_old = a->e_old;
    const double *restrict F = a->F, *restrict de = a->de, *restrict m_inverse = a->m_inverse;
#pragma omp simd
    for (ptrdiff_t i = 0; i < a->n; i++) {
        x_old[i] = x[i];
        p_old[i] = p[i];
        e_old[i] = e[i];
        x[i] += p[i] * m_inverse[i] * half;
        const double floor = 0.5 * (e[i] - kinetic * p[i] * p[i] * m_inverse[i]);
        p[i] += F[i] * half;
        const double moving = kinetic * p[i] * p[i] * m_inverse[i];
        const double U = e[i] + de[i] * half - moving;
        e[i] = (U > floor ? U : floor) + moving;
    }
    if (!simulation->plan.alpha) return;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->alpha_old[i] = a->alpha[i];
        a->alpha[i] += a->dalpha[i] * half;
    }
}

/* Returns how many particles are left without internal energy. */
CLONES static double advance_from_midpoint(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict x = a->x, *restrict p = a->p, *restrict e = a->e;
    const double *restrict F = a->F, *restrict de = a->de, *restrict m_inverse = a->m_inverse,
                           *restrict x_old = a->x_old, *restrict p_old = a->p_old,
                           *restrict e_old = a->e_old;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = 0; i < a->n; i++) {
        p[i] = p_old[i] + F[i] * dt;
        e[i] = e_old[i] + de[i] * dt;
        x[i] = x_old[i] + 0.5 * (p_old[i] + p[i]) * m_inverse[i] * dt;
        unsound += e[i] - kinetic * p[i] * p[i] * m_inverse[i] >= 0 ? 0. : 1.;
    }
    if (simulation->plan.alpha)
        for (ptrdiff_t i = 0; i < a->n; i++) a->alpha[i] = a->alpha_old[i] + a->dalpha[i] * dt;
    return unsound;
}

static enum status name_unsound(const struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    for (ptrdiff_t i = 0;; i++) {
        const double U = a->e[i] - kinetic * a->p[i] * a->p[i] * a->m_inverse[i];
        if (!(U >= 0)) return broke_down(simulation, i, "internal energy", U, error);
    }
}

static enum status predicted_midpoint_step(struct simulation *simulation, double dt,
                                           struct error *error)
{
    predict_midpoint(simulation, dt);
    const enum status status = evaluate_rates(simulation, error);
    if (status) return status;
    return advance_from_midpoint(simulation, dt) > 0 ? name_unsound(simulation, error) : STATUS_OK;
}

#endif
INTEGRATOR(predicted_midpoint,
           .member = {"predicted_midpoint", "midpoint with predicted rates, one evaluation a step",
                      "van Leer 1979"},
           .order = 2, .evaluations = 1, .cfl = 0.8, .cfl_per_width = true)
