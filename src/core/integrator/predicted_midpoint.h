/* SPDX-License-Identifier: GPL-3.0-or-later
 * Predicted midpoint: the state is predicted to the middle of the step with the rates of the last
 * midpoint, evaluated there once, and advanced over the whole step. A predicted internal energy is
 * kept above half of its initial value (strong tubes); one that is negative at the end of a step is
 * a breakdown.
 *
 * x moves as in a leapfrog, but v and U are extrapolated, which alone is unstable without viscosity
 * (quadratic_spline: beyond c dt/dx = 0.16). If h is predicted as well, the density sum provides
 * the missing information: V differs from its prediction by the same error that the prediction of U
 * has. The pressure is corrected along the adiabat, P = P(rho, U) (1 - w (gamma - 1)(V/V_predicted
 * - 1)). w = 1/2 would correct U by the second difference of the volume; 3/2 also damps the
 * shortest waves, with an error O(dt^2), and is stable up to c dt/dx = 0.80 without and 0.52 with
 * full viscosity (alpha 0.75). Wider kernels, with larger alpha, are stable up to 0.8 spacings.
 *
 * The prediction excludes particle shifting: shifts and exchanges follow from the midpoint without
 * them. If included, they would be stable only in steps half as long.
 *
 * The rates of the start do not depend on velocities: with an impulsive start a first step of
 * full length can leave cold gas without internal energy (strong_shock with mass_ratio=1.4), so
 * the first step is a quarter of it. */
#ifndef INTEGRATOR_PREDICTED_MIDPOINT_H
#define INTEGRATOR_PREDICTED_MIDPOINT_H

#include <string.h>

#include "breakdown.h"
#include "solver.h"
#include "specialise.h"
#include "width.h"

struct predicted_midpoint {
    double ahead; /* length of the step to whose middle x, v, U and alpha have been predicted; 0:
                     none */
};

/* Advances the state by dt with the rates of the midpoint, predicts it over the first half of the
 * next step `ahead`, or does both in one loop. Predicted x, v and U go to these arrays, where the
 * evaluation reads them; x_old is the position of the state; p and e remain those of the state.
 * Returns the number of particles without positive internal energy. */
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
/* by dimension; then with shifting */
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

/* Applies a move (specialised for each dimension) to all particles that move: sleeping particles in
 * moving gas drift, those at rest are skipped. Returns a count of particles, so the order of
 * summation does not matter. */
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

/* Returns from the predicted midpoint to the state, if no step follows. */
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

/* Between consecutive steps the end of one is combined with the prediction of the next. A particle
 * that wakes in between has x_old = x, alpha_old = alpha and no rates, as the prediction would have
 * left it. */
static enum status predicted_midpoint_step(struct simulation *simulation, double dt,
                                           struct error *error)
{
    struct predicted_midpoint *state = simulation->integrator_state;
    /* t_end has changed, and with it the step that was predicted */
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
