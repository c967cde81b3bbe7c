/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kick-drift-kick leapfrog with prediction: half kick, drift, the rest of the state predicted to
 * the end of the step for the evaluation, then the second half kick from the half-kicked values. */
#ifndef INTEGRATOR_LEAPFROG_H
#define INTEGRATOR_LEAPFROG_H

/* Half-kicked values go to *_old, predicted ones to the state. */
static void kick_drift(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->p_old[i] = a->p[i] + a->F[i] * (0.5 * dt);
        a->e_old[i] = a->e[i] + a->de[i] * (0.5 * dt);
        a->x[i] += a->p_old[i] * a->m_inverse[i] * dt;
        a->p[i] += a->F[i] * dt;
        a->e[i] += a->de[i] * dt;
    }
    if (!simulation->plan.alpha) return;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->alpha_old[i] = a->alpha[i] + a->dalpha[i] * (0.5 * dt);
        a->alpha[i] += a->dalpha[i] * dt;
    }
}

static void kick(struct simulation *simulation, double dt)
{
    struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->p[i] = a->p_old[i] + a->F[i] * (0.5 * dt);
        a->e[i] = a->e_old[i] + a->de[i] * (0.5 * dt);
    }
    if (!simulation->plan.alpha) return;
    for (ptrdiff_t i = 0; i < a->n; i++) a->alpha[i] = a->alpha_old[i] + a->dalpha[i] * (0.5 * dt);
}

static enum status leapfrog_step(struct simulation *simulation, double dt, struct error *error)
{
    kick_drift(simulation, dt);
    const enum status status = evaluate_rates(simulation, error);
    if (status == STATUS_OK) kick(simulation, dt);
    return status;
}

#endif
INTEGRATOR(leapfrog, .member = {"leapfrog", "kick-drift-kick leapfrog", "Springel 2005"},
           .order = 2, .evaluations = 1, .cfl = 0.3, .signal_pass = true)
