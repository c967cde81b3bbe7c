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

/* Advances the state by dt from its middle, predicts it for the first half of the step ahead, or
 * both in one walk over memory. Predicted x, v and U go where the evaluation reads them, x_old is
 * the position of the state; p and e stay those of the state. Returns how many particles are left
 * without internal energy. */
ALWAYS_INLINE double move_body(bool advance, bool predict, const struct simulation *simulation,
                               const struct span *span, double dt, double ahead)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t end = span->first + span->len;
    const double half = 0.5 * ahead;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict x = a->x, *restrict x_old = a->x_old, *restrict v = a->v, *restrict U = a->U,
                     *restrict p = a->p, *restrict e = a->e;
    const double *restrict F = a->F, *restrict de = a->de, *restrict m_inverse = a->m_inverse;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = span->first; i < end; i++) {
        double p_now = p[i], e_now = e[i], x_now = x[i];
        if (advance) {
            p_now += F[i] * dt;
            e_now += de[i] * dt;
            x_now = x_old[i] + 0.5 * (p[i] + p_now) * m_inverse[i] * dt;
            p[i] = p_now;
            e[i] = e_now;
        }
        const double v_now = p_now * m_inverse[i], U_now = e_now - kinetic * p_now * v_now;
        unsound += U_now > 0 ? 0. : 1.;
        if (predict) {
            const double p_half = p_now + F[i] * half, v_half = p_half * m_inverse[i];
            x_old[i] = x_now;
            v[i] = v_half;
            U[i] = largest(e_now + de[i] * half - kinetic * p_half * v_half, 0.5 * U_now);
            x_now += v_now * half;
        }
        x[i] = x_now;
    }
    for (ptrdiff_t i = span->first; simulation->plan.alpha && i < end; i++) {
        if (advance) a->alpha[i] = a->alpha_old[i] + a->dalpha[i] * dt;
        a->alpha_old[i] = a->alpha[i];
        if (predict) a->alpha[i] += a->dalpha[i] * half;
    }
    return unsound;
}

typedef double move(const struct simulation *simulation, const struct span *span, double dt,
                    double ahead);

#define MOVE(name, advance, predict)                                                               \
    CLONES static double name(const struct simulation *simulation, const struct span *span,        \
                              double dt, double ahead)                                             \
    {                                                                                              \
        return move_body(advance, predict, simulation, span, dt, ahead);                           \
    }
MOVE(predict_midpoint, false, true)
MOVE(advance_from_midpoint, true, false)
MOVE(advance_and_predict, true, true)

/* One of them over all that moves: sleepers in moving gas drift, those at rest are left
 * alone. A count of particles: its sum does not depend on the order. */
static double move_all(const struct simulation *simulation, move *walk, double dt, double ahead)
{
    const struct sleep *sleep = &simulation->sleep;
    const struct span all = {0, simulation->particles.n};
    const bool spans = sleep->on && sleep->at_rest;
    double count = 0;
    for (ptrdiff_t s = 0; s < (spans ? sleep->span_count : 1); s++) {
        const struct span *span = spans ? &sleep->spans[s] : &all;
        const ptrdiff_t parts = span->len >= WORTH_A_THREAD * RANGE_MAX ? simulation->threads : 1;
        if (parts == 1) {
            count += walk(simulation, span, dt, ahead);
            continue;
        }
#pragma omp parallel for num_threads((int)parts) reduction(+ : count)
        for (ptrdiff_t k = 0; k < parts; k++) {
            const ptrdiff_t begin = span->len * k / parts, end = span->len * (k + 1) / parts;
            count += walk(simulation, &(struct span){span->first + begin, end - begin}, dt, ahead);
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

/* While steps follow each other, the end of one is joined with the prediction of the next. Should
 * somebody wake in between: those who slept have x_old = x, alpha_old = alpha
 * and no rates, which is what the prediction would have left. */
static enum status predicted_midpoint_step(struct simulation *simulation, double dt,
                                           struct error *error)
{
    if (simulation->ahead <= 0) move_all(simulation, predict_midpoint, 0, dt);
    const enum status status = evaluate_rates_of_primitives(simulation, error);
    if (status) return status;
    const double ahead = simulation_next_step(simulation, simulation_time_after(simulation, dt));
    const double unsound =
        move_all(simulation, ahead > 0 ? advance_and_predict : advance_from_midpoint, dt, ahead);
    simulation->ahead = ahead;
    return unsound > 0 ? name_unsound(simulation, error) : STATUS_OK;
}

#endif
INTEGRATOR(predicted_midpoint,
           .member = {"predicted_midpoint", "midpoint with predicted rates, one evaluation a step",
                      "van Leer 1979"},
           .order = 2, .evaluations = 1, .cfl = 0.8, .cfl_per_width = true, .predicts = true,
           .follow = 1.5, .first_step = 0.25)
