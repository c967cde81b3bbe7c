/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steps.h"

#include <math.h>

#include "breakdown.h"
#include "solver.h"
#include "stamp.h"
#include "width.h"

/* A block's levels only pay where they leave out this part of the work. */
static const double worth = 0.9;

/* A particle's pace is at least this part of its fastest neighbour's, so that a shock finds short
 * steps when it arrives (Saitoh & Makino 2009). */
static const double close_to = 0.5;

/* Inside a block a particle keeps the finest planned level while its step is this much too long:
 * the next block will have shorter ones. */
static const double patience = 1.1;

/* Time inside a block in ticks, two of which are a step of the finest level of all. */
struct clock {
    int finest;    /* that level */
    long now, end; /* ticks */
    double tick;
};

static long length_of(const struct clock *clock, int level)
{
    return clock->end >> level;
}

/* The coarsest level with a step that ends now. */
static int coarsest_at(const struct clock *clock)
{
    int level = 0;
    while (clock->now % length_of(clock, level) != 0) level++;
    return level;
}

/* The level that has the middle of a step now; beyond the finest: none. */
static int middle_at(const struct clock *clock)
{
    int level = 0;
    while (level <= clock->finest &&
           clock->now % length_of(clock, level) != length_of(clock, level) / 2)
        level++;
    return level;
}

static double pace_of(const struct particles *a, ptrdiff_t i)
{
    return largest(a->signal[i] * a->h_inverse[i], close_to * a->near_pace[i]);
}

/* The level of a particle among those down to `depth` of a block. */
static int level_for(const struct simulation *simulation, double pace, double block, int depth)
{
    const double cfl = simulation->scheme.cfl * (1 + 1e-9);
    int level = 0;
    while (level < depth && pace * ldexp(block, -level) > cfl) level++;
    if (level < depth || pace * ldexp(block, -level) <= patience * cfl) return level;
    while (level < depth + STEPS_SPARE && pace * ldexp(block, -level) > cfl) level++;
    return level;
}

/* Work of a block of that depth, in evaluations of a particle for each finest step. */
static double work_of(const struct simulation *simulation, double dt, int depth)
{
    const struct particles *a = &simulation->particles;
    double work = 0;
    for (ptrdiff_t i = 0; i < a->n; i++)
        work += ldexp(1, level_for(simulation, a->pace[i], ldexp(dt, depth), depth) - depth);
    return work / (double)a->n;
}

double steps_begin_block(struct simulation *simulation, double dt, double left)
{
    struct steps *steps = &simulation->steps;
    const struct particles *a = &simulation->particles;
    if (!(simulation->dt > 0)) /* the first step: everybody's, from rates that know no velocities */
        for (ptrdiff_t i = 0; i < a->n; i++) {
            for (int k = 0; k < a->dim; k++) {
                a->F_mean[k][i] = a->F[k][i];
                a->x_old[k][i] = a->x[k][i];
            }
            a->de_mean[i] = a->de[i];
            a->near_pace[i] = 0;
            a->pace[i] = pace_of(a, i);
        }
    double slowest = HUGE_VAL;
    for (ptrdiff_t i = 0; i < a->n; i++) slowest = fmin(slowest, a->pace[i]);
    /* one level more than the last block at most: paces of neighbours' neighbours have come no
     * further */
    int depth = simulation->dt > 0 ? steps->depth + 1 : 0;
    if (depth > STEPS_DEPTH) depth = STEPS_DEPTH;
    while (depth > 0 && (ldexp(dt, depth) > left ||
                         slowest * ldexp(dt, depth) > simulation->scheme.cfl * (1 + 1e-9)))
        depth--;
    if (depth > 0 && work_of(simulation, dt, depth) > worth) depth = 0;
    steps->depth = depth;
    return ldexp(dt, depth);
}

/* --- prediction ------------------------------------------------------------------------------- */

/* Where the particles of a batch are in their steps. */
struct places {
    double s[BATCH_MAX], half[BATCH_MAX]; /* since the step began; half of the step */
    double active[BATCH_MAX];             /* 1: at the middle of the level that is evaluated */
};

/* 1/h from the last two sums (CONVENTIONS eq. 3.11), by a quarter at most. Between them lies the
 * span, or, beyond the middle of the step, half of the last two steps. */
ALWAYS_INLINE void predict_widths(const struct particles *a, ptrdiff_t first, int len,
                                  const struct places *at)
{
    const double *restrict before = a->before + first, *restrict span = a->span + first,
                           *restrict found = a->h_inverse_found + first;
    double *restrict h_inverse = a->h_inverse + first, *restrict last = a->h_inverse_old + first,
                     *restrict ratio_of = a->ratio + first;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double half = at->half[i], s = at->s[i];
        const bool beyond = s > half;
        const double passed = beyond ? s - half : 0.5 * before[i] + s;
        const double between = beyond ? 0.5 * before[i] + half : span[i];
        const double ratio = between > 0 ? passed / between : 0;
        ratio_of[i] = ratio;
        const double next = found[i] + ratio * (found[i] - last[i]);
        h_inverse[i] = largest(0.8 * found[i], least(1.25 * found[i], next));
        last[i] = at->active[i] > 0 ? found[i] : last[i];
    }
}

/* What an inactive particle's neighbours see of it: volume from the width, CONVENTIONS eq. 3.4, and
 * the equation of state. Of active ones it is found from their sums. */
ALWAYS_INLINE void predict_gas(int dim, const struct simulation *simulation, ptrdiff_t first,
                               int len)
{
    const struct particles *a = &simulation->particles;
    const double gamma_1 = simulation->gamma - 1, eta_inverse = 1 / simulation->scheme.eta,
                 square = simulation->gamma * gamma_1;
    const double *restrict h_inverse = a->h_inverse + first, *restrict U = a->U + first,
                           *restrict m = a->m + first, *restrict m_inverse = a->m_inverse + first;
    double *restrict V = a->V + first, *restrict rho = a->rho + first, *restrict P = a->P + first,
                     *restrict c = a->c + first;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        /* V = (h/eta)^d */
        const double hs = h_inverse[i], n = dim == 2 ? hs * hs : hs * hs * hs;
        const double scale =
            dim == 2 ? eta_inverse * eta_inverse : eta_inverse * eta_inverse * eta_inverse;
        const double volume = scale / n, V_inverse = n / scale;
        V[i] = volume;
        rho[i] = m[i] * V_inverse;
        P[i] = gamma_1 * U[i] * V_inverse;
        c[i] = sqrt(square * U[i] * m_inverse[i]);
    }
}

/* Position, velocity, internal energy and width of a batch. At the middle of a particle's own step,
 * as predicted_midpoint has it; elsewhere with the mean rates that are known by now. */
ALWAYS_INLINE void predict_body(int dim, const struct simulation *simulation, ptrdiff_t first,
                                int len, const struct places *at)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0;
    const double *restrict e = a->e + first, *restrict de = a->de_mean + first,
                           *restrict m_inverse = a->m_inverse + first;
    double *restrict U = a->U + first;
    const double *restrict p[3], *restrict F[3], *restrict x_old[3];
    double *restrict x[3], *restrict v[3];
    for (int k = 0; k < dim; k++) {
        p[k] = a->p[k] + first, F[k] = a->F_mean[k] + first, x_old[k] = a->x_old[k] + first;
        x[k] = a->x[k] + first, v[k] = a->v[k] + first;
    }
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double s = at->s[i], bend = at->active[i] > 0 ? 0 : 0.5 * s * s * m_inverse[i];
        double U_now = e[i], U_then = e[i] + de[i] * s;
        for (int k = 0; k < dim; k++) {
            const double v_now = p[k][i] * m_inverse[i], p_then = p[k][i] + F[k][i] * s,
                         v_then = p_then * m_inverse[i];
            U_now -= kinetic * p[k][i] * v_now;
            U_then -= kinetic * p_then * v_then;
            x[k][i] = x_old[k][i] + v_now * s + bend * F[k][i];
            v[k][i] = v_then;
        }
        U[i] = largest(U_then, 0.5 * U_now);
    }
    predict_widths(a, first, len, at);
    predict_gas(dim, simulation, first, len);
}

CLONES static void predict_2(const struct simulation *simulation, ptrdiff_t first, int len,
                             const struct places *at)
{
    predict_body(2, simulation, first, len, at);
}

CLONES static void predict_3(const struct simulation *simulation, ptrdiff_t first, int len,
                             const struct places *at)
{
    predict_body(3, simulation, first, len, at);
}

/* All particles now. Returns how many are active. */
static uint64_t predict(const struct simulation *simulation, const struct clock *clock, int level)
{
    const struct particles *a = &simulation->particles;
    double s[STEPS_DEPTH + STEPS_SPARE + 1], half[STEPS_DEPTH + STEPS_SPARE + 1];
    double active = 0;
    for (int b = 0; b <= clock->finest; b++) {
        s[b] = clock->tick * (double)(clock->now % length_of(clock, b));
        half[b] = clock->tick * (double)(length_of(clock, b) / 2);
    }
#pragma omp parallel for num_threads(simulation->team.size) reduction(+ : active)                  \
    if (simulation->team.size > 1)
    for (ptrdiff_t first = 0; first < a->n; first += BATCH_MAX) {
        const int len = (int)(a->n - first < BATCH_MAX ? a->n - first : BATCH_MAX);
        struct places at;
        for (int i = 0; i < len; i++) {
            const int own = (int)a->level[first + i];
            at.s[i] = s[own];
            at.half[i] = half[own];
            at.active[i] = own == level ? 1 : 0;
            active += at.active[i];
        }
        (a->dim == 2 ? predict_2 : predict_3)(simulation, first, len, &at);
    }
    return (uint64_t)active;
}

/* --- evaluation ------------------------------------------------------------------------------- */

/* The mean rates of the step that active particles are in the middle of: those of their own pairs,
 * and what finer pairs have given in the first half. */
static void find_mean_rates(const struct simulation *simulation, const struct clock *clock)
{
    const struct particles *a = &simulation->particles;
    const int level = (int)simulation->steps.level;
    const double inverse = 1 / (0.5 * clock->tick * (double)length_of(clock, level));
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if ((int)a->level[i] > level) continue;
        a->pace[i] = pace_of(a, i);
        if ((int)a->level[i] < level) continue;
        for (int k = 0; k < a->dim; k++) a->F_mean[k][i] = a->F[k][i] + a->impulse[k][i] * inverse;
        a->de_mean[i] = a->de[i] + a->heat[i] * inverse;
    }
}

static enum status evaluate_level(struct simulation *simulation, const struct clock *clock,
                                  int level, struct error *error)
{
    struct steps *steps = &simulation->steps;
    const uint64_t active = predict(simulation, clock, level);
    steps->level = level;
    steps->span = clock->tick * (double)length_of(clock, level);
    steps->updates += active;
    const enum status status = evaluate_rates_of_primitives(simulation, error);
    if (!status) find_mean_rates(simulation, clock);
    steps->level = -1;
    return status;
}

/* --- steps ------------------------------------------------------------------------------------ */

/* Ends the step of a particle. Returns its internal energy. */
static double end_step(const struct simulation *simulation, double dt, ptrdiff_t i)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0, inverse = 1 / dt;
    a->e[i] = a->e[i] + a->de[i] * dt + a->heat[i];
    a->de_mean[i] = a->de[i] + a->heat[i] * inverse;
    a->heat[i] = 0;
    double U = a->e[i];
    for (int k = 0; k < a->dim; k++) {
        const double p = a->p[k][i], p_now = p + a->F[k][i] * dt + a->impulse[k][i];
        a->x_old[k][i] = a->x[k][i] = a->x_old[k][i] + 0.5 * (p + p_now) * a->m_inverse[i] * dt;
        a->p[k][i] = p_now;
        a->F_mean[k][i] = a->F[k][i] + a->impulse[k][i] * inverse;
        a->impulse[k][i] = 0;
        U -= kinetic * p_now * (p_now * a->m_inverse[i]);
    }
    a->span[i] = simulation->steps.depth > 0 ? 0.5 * (a->before[i] + dt) : dt;
    a->before[i] = dt;
    return U;
}

/* Ends the steps that end now, and chooses the next levels of their particles. */
static enum status end_steps(struct simulation *simulation, const struct clock *clock, double block,
                             struct error *error)
{
    const struct particles *a = &simulation->particles;
    const int coarsest = coarsest_at(clock);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const int level = (int)a->level[i];
        if (level < coarsest) continue;
        const double U = end_step(simulation, clock->tick * (double)length_of(clock, level), i);
        if (!(U > 0)) return breakdown_of(simulation, i, "internal energy", U, error);
        const int next = level_for(simulation, a->pace[i], block, simulation->steps.depth);
        a->level[i] = next > coarsest ? next : coarsest;
    }
    return STATUS_OK;
}

static int finest_of(const struct particles *a)
{
    double finest = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) finest = largest(finest, a->level[i]);
    return (int)finest;
}

static bool has_level(const struct particles *a, int level)
{
    bool has = false;
    for (ptrdiff_t i = 0; i < a->n; i++) has |= (int)a->level[i] == level;
    return has;
}

enum status steps_block(struct simulation *simulation, double dt, struct error *error)
{
    struct steps *steps = &simulation->steps;
    const struct particles *a = &simulation->particles;
    struct clock clock = {.finest = steps->depth + STEPS_SPARE};
    clock.end = 2L << clock.finest;
    clock.tick = dt / (double)clock.end;
    steps->updates = 0;
    for (ptrdiff_t i = 0; i < a->n; i++)
        a->level[i] = level_for(simulation, a->pace[i], dt, steps->depth);
    while (clock.now < clock.end) {
        clock.now += length_of(&clock, finest_of(a)) / 2;
        enum status status = STATUS_OK;
        if (coarsest_at(&clock) <= finest_of(a)) status = end_steps(simulation, &clock, dt, error);
        const int level = middle_at(&clock);
        if (!status && clock.now < clock.end && has_level(a, level))
            status = evaluate_level(simulation, &clock, level, error);
        if (status) return status;
    }
    double rate = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) rate = largest(rate, a->signal[i] * a->h_inverse[i]);
    simulation->time_step = simulation->scheme.cfl / rate;
    return STATUS_OK;
}
