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
 * Particle shifting is no part of the prediction: what particles shift and exchange in a step
 * follows from the middle without it. With it a shift would be stable in steps half as long.
 *
 * The rates of the start know no velocities: at an impulsive start a first step of full length can
 * leave cold gas without internal energy (strong_shock with mass_ratio=1.4), so it is a quarter. */
#ifndef INTEGRATOR_PREDICTED_MIDPOINT_H
#define INTEGRATOR_PREDICTED_MIDPOINT_H

#include <string.h>

#include "breakdown.h"
#include "solver.h"
#include "specialise.h"
#include "width.h"

struct predicted_midpoint {
    double ahead; /* the step whose middle x, v, U and alpha are at already; 0: none */
};

/* Advances the state by dt from its middle, predicts it for the first half of the step ahead, or
 * both in one walk over memory. Predicted x, v and U go where the evaluation reads them, x_old is
 * the position of the state; p and e stay those of the state. Returns how many particles are left
 * without internal energy. */
ALWAYS_INLINE double move_body(int dim, bool advance, bool predict, bool shifts,
                               const struct simulation *simulation, const struct span *span,
                               double dt, double ahead)
{
    const struct particles *a = &simulation->particles;
    const ptrdiff_t end = span->first + span->len;
    const double half = 0.5 * ahead;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    double *restrict U = a->U, *restrict e = a->e;
    const double *restrict de = a->de, *restrict dm = a->dm, *restrict de_shift = a->de_shift;
    double *restrict m = a->m, *restrict m_inverse = a->m_inverse;
    double *restrict x[3], *restrict x_old[3], *restrict v[3], *restrict p[3];
    const double *restrict F[3], *restrict shift[3], *restrict dp_shift[3];
    for (int k = 0; k < dim; k++)
        x[k] = a->x[k], x_old[k] = a->x_old[k], v[k] = a->v[k], p[k] = a->p[k], F[k] = a->F[k],
        shift[k] = a->shift[k], dp_shift[k] = a->dp_shift[k];
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = span->first; i < end; i++) {
        double e_now = advance ? e[i] + de[i] * dt : e[i];
        const double inverse_before = m_inverse[i];
        double inverse = inverse_before;
        if (shifts && advance) {
            m[i] += dm[i] * dt;
            m_inverse[i] = inverse = 1 / m[i];
            e_now += de_shift[i] * dt;
        }
        double U_now = e_now, U_half = e_now + de[i] * half;
        for (int k = 0; k < dim; k++) {
            double p_now = p[k][i], x_now = x[k][i];
            if (advance) {
                p_now += F[k][i] * dt;
                if (shifts) p_now += dp_shift[k][i] * dt;
                x_now = shifts ? x_old[k][i] + (0.5 * (p[k][i] * inverse_before + p_now * inverse) +
                                                shift[k][i]) *
                                                   dt
                               : x_old[k][i] + 0.5 * (p[k][i] + p_now) * inverse * dt;
                p[k][i] = p_now;
            }
            const double v_now = p_now * inverse;
            U_now -= kinetic * p_now * v_now;
            if (predict) {
                const double p_half = p_now + F[k][i] * half, v_half = p_half * inverse;
                x_old[k][i] = x_now;
                v[k][i] = v_half;
                U_half -= kinetic * p_half * v_half;
                x_now += v_now * half;
            }
            x[k][i] = x_now;
        }
        if (advance) e[i] = e_now;
        if (predict) U[i] = largest(U_half, 0.5 * U_now);
        unsound += U_now > 0 ? 0. : 1.;
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

#define MOVE(name, advance, predict, shifts, dim)                                                  \
    CLONES static double name##_##dim(const struct simulation *simulation,                         \
                                      const struct span *span, double dt, double ahead)            \
    {                                                                                              \
        return move_body(dim, advance, predict, shifts, simulation, span, dt, ahead);              \
    }
/* by dimension; then those that shift */
#define MOVES(name, advance, predict)                                                              \
    MOVE(name, advance, predict, false, 1)                                                         \
    MOVE(name, advance, predict, false, 2)                                                         \
    MOVE(name, advance, predict, false, 3)                                                         \
    MOVE(name##_shifting, advance, predict, true, 2)                                               \
    MOVE(name##_shifting, advance, predict, true, 3)                                               \
    static move *const name[] = {name##_1, name##_2,          name##_3,                            \
                                 NULL,     name##_shifting_2, name##_shifting_3};
MOVES(predict_midpoint, false, true)
MOVES(advance_from_midpoint, true, false)
MOVES(advance_and_predict, true, true)
#undef MOVES
#undef MOVE

/* One of them (specialised for each dimension) over all that moves: sleepers in moving gas drift,
 * those at rest are left alone. A count of particles: its sum does not depend on the order. */
static double move_all(const struct simulation *simulation, move *const *walks, double dt,
                       double ahead)
{
    move *const walk = walks[simulation->plan.dim - 1 + (simulation->plan.shift ? 3 : 0)];
    const struct sleep *sleep = &simulation->sleep;
    const struct span all = {0, simulation->particles.n};
    const bool spans = sleep->on && sleep->at_rest;
    double count = 0;
    for (ptrdiff_t s = 0; s < (spans ? sleep->span_count : 1); s++) {
        const struct span *span = spans ? &sleep->spans[s] : &all;
        const ptrdiff_t parts = span->len >= WORTH_A_THREAD * BATCH_MAX ? simulation->team.size : 1;
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
        double U = a->e[i];
        for (int k = 0; k < a->dim; k++) U -= kinetic * a->p[k][i] * a->p[k][i] * a->m_inverse[i];
        if (!(U > 0)) return breakdown_of(simulation, i, "internal energy", U, error);
    }
}

/* Back from the middle of a step that does not follow. */
static void predicted_midpoint_synchronise(struct simulation *simulation)
{
    struct predicted_midpoint *state = simulation->integrator_state;
    const struct particles *a = &simulation->particles;
    const size_t bytes = (size_t)a->n * sizeof(double);
    if (state->ahead <= 0) return;
    for (int k = 0; k < a->dim; k++) memcpy(a->x[k], a->x_old[k], bytes);
    if (simulation->plan.alpha) memcpy(a->alpha, a->alpha_old, bytes);
    state->ahead = 0;
}

/* While steps follow each other, the end of one is joined with the prediction of the next. A
 * particle that wakes in between has x_old = x, alpha_old = alpha and no rates, which is what the
 * prediction would have left. */
static enum status predicted_midpoint_step(struct simulation *simulation, double dt,
                                           struct error *error)
{
    struct predicted_midpoint *state = simulation->integrator_state;
    /* t_end has come nearer: another step than was predicted for */
    if (state->ahead > 0 && state->ahead != dt) predicted_midpoint_synchronise(simulation);
    if (state->ahead <= 0) move_all(simulation, predict_midpoint, 0, dt);
    const enum status status = evaluate_rates_of_primitives(simulation, error);
    if (status) return status;
    const double ahead = simulation_next_step(simulation, simulation_time_after(simulation, dt));
    const double unsound =
        move_all(simulation, ahead > 0 ? advance_and_predict : advance_from_midpoint, dt, ahead);
    state->ahead = ahead;
    return unsound > 0 ? name_unsound(simulation, error) : STATUS_OK;
}

#endif
INTEGRATOR(predicted_midpoint,
           .member = {"predicted_midpoint", "midpoint with predicted rates, one evaluation a step",
                      "van Leer 1979"},
           .order = 2, .evaluations = 1, .cfl = 0.8, .cloud_cfl = 1.4, .closed_cfl = 1,
           .cfl_per_width = true, .predicts = true, .follow = 1.5, .first_step = 0.25,
           .local = true, .shifts = true, .keeps = sizeof(struct predicted_midpoint),
           .synchronise = predicted_midpoint_synchronise)
