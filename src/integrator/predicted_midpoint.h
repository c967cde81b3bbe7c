/* SPDX-License-Identifier: GPL-3.0-or-later
 * Predicted midpoint: the state is predicted to the middle of the step with the rates of the last
 * midpoint, evaluated there once, and advanced over the whole step. A predicted internal energy is
 * kept above half of its start (strong tubes); one that turns negative at the end of a step is a
 * breakdown.
 *
 * x moves as in a leapfrog, but v and U are extrapolated, and alone that is unstable without
 * viscosity (quadratic_spline: beyond c dt/dx = 0.16). Where h is predicted, too, the density sum
 * knows better: V differs from its prediction by what the prediction of U cannot know either.
 * The pressure follows on the adiabat, P = P(rho, U) (1 - w (gamma - 1)(V/V_predicted - 1)).
 * w = 1/2 would give U the volume's second difference; 3/2 also damps the shortest waves, with an
 * error O(dt^2), and is stable up to c dt/dx = 0.80 without and 0.52 with all of the viscosity
 * (alpha 0.75). Wider kernels, with larger alpha, keep to 0.8 spacings.
 *
 * The rates of the start know no velocities: at an impulsive start a first step of full length can
 * leave cold gas without internal energy (strong_shock with mass_ratio=1.4), so it is a quarter. */
#ifndef INTEGRATOR_PREDICTED_MIDPOINT_H
#define INTEGRATOR_PREDICTED_MIDPOINT_H

/* The predicted x, v and U go where the evaluation reads them; p and e stay those of the state. */
CLONES static double predict_midpoint(const struct simulation *simulation, const struct span *span,
                                      double dt)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t end = span->first + span->len;
    const double half = 0.5 * dt;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict x = a->x, *restrict x_old = a->x_old, *restrict v = a->v, *restrict U = a->U;
    const double *restrict F = a->F, *restrict de = a->de, *restrict m_inverse = a->m_inverse,
                           *restrict p = a->p, *restrict e = a->e;
#pragma omp simd
    for (ptrdiff_t i = span->first; i < end; i++) {
        const double v_now = p[i] * m_inverse[i];
        const double U_now = e[i] - kinetic * p[i] * v_now;
        const double p_half = p[i] + F[i] * half, v_half = p_half * m_inverse[i];
        x_old[i] = x[i];
        x[i] += v_now * half;
        v[i] = v_half;
        U[i] = largest(e[i] + de[i] * half - kinetic * p_half * v_half, 0.5 * U_now);
    }
    for (ptrdiff_t i = span->first; simulation->plan.alpha && i < end; i++) {
        a->alpha_old[i] = a->alpha[i];
        a->alpha[i] += a->dalpha[i] * half;
    }
    return 0;
}

/* Returns how many particles are left without internal energy. */
CLONES static double advance_from_midpoint(const struct simulation *simulation,
                                           const struct span *span, double dt)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t end = span->first + span->len;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict x = a->x, *restrict p = a->p, *restrict e = a->e;
    const double *restrict F = a->F, *restrict de = a->de, *restrict m_inverse = a->m_inverse,
                           *restrict x_old = a->x_old;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = span->first; i < end; i++) {
        const double p_new = p[i] + F[i] * dt;
        x[i] = x_old[i] + 0.5 * (p[i] + p_new) * m_inverse[i] * dt;
        p[i] = p_new;
        e[i] += de[i] * dt;
        unsound += e[i] - kinetic * p_new * p_new * m_inverse[i] > 0 ? 0. : 1.;
    }
    if (simulation->plan.alpha)
        for (ptrdiff_t i = span->first; i < end; i++)
            a->alpha[i] = a->alpha_old[i] + a->dalpha[i] * dt;
    return unsound;
}

/* One of the two above over all that moves: sleepers in moving gas drift, those at rest are left
 * alone. A count of particles: its sum does not depend on the order. */
static double move_all(const struct simulation *simulation, double dt,
                       double (*move)(const struct simulation *, const struct span *, double))
{
    const struct sleep *sleep = &simulation->sleep;
    const struct span all = {0, simulation->particles.n};
    const bool spans = sleep->on && sleep->at_rest;
    double count = 0;
    for (ptrdiff_t s = 0; s < (spans ? sleep->span_count : 1); s++) {
        const struct span *span = spans ? &sleep->spans[s] : &all;
        const ptrdiff_t parts = span->len >= WORTH_A_THREAD * RANGE_MAX ? simulation->threads : 1;
        if (parts == 1) {
            count += move(simulation, span, dt);
            continue;
        }
#pragma omp parallel for num_threads((int)parts) reduction(+ : count)
        for (ptrdiff_t k = 0; k < parts; k++) {
            const ptrdiff_t begin = span->len * k / parts, end = span->len * (k + 1) / parts;
            count += move(simulation, &(struct span){span->first + begin, end - begin}, dt);
        }
    }
    return count;
}

static enum status name_unsound(const struct simulation *simulation, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    for (ptrdiff_t i = 0;; i++) {
        const double U = a->e[i] - kinetic * a->p[i] * a->p[i] * a->m_inverse[i];
        if (!(U > 0)) return broke_down(simulation, i, "internal energy", U, error);
    }
}

/* Should all wake in between, because particles have crossed: those who slept have x_old = x and no
 * rates, which is what the prediction would have left. */
static enum status predicted_midpoint_step(struct simulation *simulation, double dt,
                                           struct error *error)
{
    move_all(simulation, dt, predict_midpoint);
    const enum status status = evaluate_rates_of_primitives(simulation, error);
    if (status) return status;
    const double unsound = move_all(simulation, dt, advance_from_midpoint);
    return unsound > 0 ? name_unsound(simulation, error) : STATUS_OK;
}

#endif
INTEGRATOR(predicted_midpoint,
           .member = {"predicted_midpoint", "midpoint with predicted rates, one evaluation a step",
                      "van Leer 1979"},
           .order = 2, .evaluations = 1, .cfl = 0.8, .cfl_per_width = true, .follow = 1.5,
           .first_step = 0.25)
