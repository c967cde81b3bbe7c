/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "steps.h"

#include <math.h>

#include "breakdown.h"
#include "solver.h"
#include "specialise.h"
#include "width.h"

/* A particle's pace is at least this fraction of its fastest neighbour's, so that a shock meets
 * short steps (Saitoh & Makino 2009). */
static const double close_to = 0.5;

/* Inside a block a particle keeps the finest planned level while its step is too long by at most
 * this factor: the next block will have shorter steps. */
static const double patience = 1.1;

/* Number of single steps between two tests whether blocks pay, and after blocks that did not. */
enum { LOOK_EVERY = 4, REST = 32 };

static long length_of(const struct steps_clock *clock, int level)
{
    return clock->end >> level;
}

/* The coarsest level with a step that ends at the current tick. */
static int coarsest_at(const struct steps_clock *clock)
{
    int level = 0;
    while (clock->now % length_of(clock, level) != 0) level++;
    return level;
}

/* The level with the middle of a step at the current tick; finest + 1: none. */
static int middle_at(const struct steps_clock *clock)
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

/* The level of a particle for its pace, up to `depth` or, if that is too coarse, a spare level. */
static int level_for(const struct simulation *simulation, double pace, double block, int depth)
{
    const double cfl = simulation->scheme.cfl * (1 + 1e-9);
    int level = 0;
    while (level < depth && pace * ldexp(block, -level) > cfl) level++;
    if (level < depth || pace * ldexp(block, -level) <= patience * cfl) return level;
    while (level < depth + STEPS_SPARE && pace * ldexp(block, -level) > cfl) level++;
    return level;
}

/* Work of a block of this depth: evaluations per particle for each finest step. */
static double work_of(const struct simulation *simulation, double dt, int depth)
{
    const struct particles *a = &simulation->particles;
    double work = 0;
    for (ptrdiff_t i = 0; i < a->n; i++)
        work += ldexp(1, level_for(simulation, a->pace[i], ldexp(dt, depth), depth) - depth);
    return work / (double)a->n;
}

/* True if a block of this depth is cheaper than single steps of the awake particles. */
static bool pays(const struct simulation *simulation, double dt, int depth)
{
    const double awake = (double)simulation->sleep.awake_count / (double)simulation->particles.n;
    return work_of(simulation, dt, depth) <= simulation->steps.worth * awake;
}

/* Prepares the first block after single steps, which do not set the fields of local steps. The
 * rates are those of the last midpoint. */
static void take_over(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    simulation->scheme.integrator->synchronise(simulation);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        for (int k = 0; k < a->dim; k++) {
            a->F_mean[k][i] = a->F[k][i];
            a->x_old[k][i] = a->x[k][i];
            a->impulse[k][i] = 0;
        }
        a->de_mean[i] = a->de[i];
        a->heat[i] = 0;
        a->before[i] = a->span[i] = simulation->dt;
    }
}

/* Sets the paces without those of the neighbours. */
static void find_own_paces(const struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++) {
        a->near_pace[i] = 0;
        a->pace[i] = pace_of(a, i);
    }
}

/* The depth of the next block, at most one more than the last: paces spread by one neighbour in
 * each block. */
static int find_depth(const struct simulation *simulation, double dt, double left)
{
    const struct particles *a = &simulation->particles;
    double slowest = HUGE_VAL;
    for (ptrdiff_t i = 0; i < a->n; i++) slowest = fmin(slowest, a->pace[i]);
    int depth = simulation->steps.depth + 1;
    if (depth > STEPS_DEPTH) depth = STEPS_DEPTH;
    while (depth > 0 && (ldexp(dt, depth) > left ||
                         slowest * ldexp(dt, depth) > simulation->scheme.cfl * (1 + 1e-9)))
        depth--;
    return depth > 0 && pays(simulation, dt, depth) ? depth : 0;
}

double steps_begin_block(struct simulation *simulation, double dt, double left)
{
    struct steps *steps = &simulation->steps;
    if (!(simulation->dt > 0)) {
        steps->single = true;
        return dt;
    }
    if (steps->single) {
        steps->depth = 0;
        if (steps->rest-- > 0) return dt;
        steps->rest = LOOK_EVERY - 1;
        find_own_paces(simulation);
        if (2 * dt > left || !pays(simulation, dt, 1)) return dt;
        take_over(simulation);
        steps->single = false; /* this step has one level; it sets paces */
        return dt;
    }
    const int before = steps->depth;
    steps->depth = find_depth(simulation, dt, left);
    /* in single steps h is predicted from the last step, which all particles must have taken */
    if (steps->depth == 0 && before == 0) {
        steps->single = true;
        steps->rest = REST;
    }
    return ldexp(dt, steps->depth);
}

/* --- prediction ------------------------------------------------------------------------------- */

/* Time of the particles of a batch within their steps. */
struct places {
    double s[BATCH_MAX], half[BATCH_MAX]; /* time since the step began; half of the step */
    double active[BATCH_MAX]; /* 1: on the level being evaluated, at the middle of the step */
};

/* Extrapolates 1/h from the last two sums (CONVENTIONS eq. 3.11), by at most a quarter. The time
 * between these is span, or, beyond the middle of the step, half of the last two steps. */
ALWAYS_INLINE void predict_widths(const struct particles *a, ptrdiff_t first, int len,
                                  const struct places *at)
{
    const double *restrict before = a->before + first, *restrict span = a->span + first,
                           *restrict found = a->h_inverse_found + first;
    const double *restrict last = a->h_inverse_old + first;
    double *restrict h_inverse = a->h_inverse + first, *restrict ratio_of = a->ratio + first;
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
    }
}

/* Sets the volume from h, CONVENTIONS eq. 3.4, and the equation of state. The sums of active
 * particles replace these values later. */
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

/* Predicts position, velocity, internal energy and h of a batch: at the middle of a particle's own
 * step as predicted_midpoint does, otherwise with the known mean rates. */
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

/* Predicts all particles to the current tick. */
static void predict(const struct simulation *simulation)
{
    const struct steps_clock *clock = &simulation->steps.clock;
    const int level = simulation->steps.level;
    const struct particles *a = &simulation->particles;
    double s[STEPS_DEPTH + STEPS_SPARE + 1], half[STEPS_DEPTH + STEPS_SPARE + 1];
    for (int b = 0; b <= clock->finest; b++) {
        s[b] = clock->tick * (double)(clock->now % length_of(clock, b));
        half[b] = clock->tick * (double)(length_of(clock, b) / 2);
    }
#pragma omp parallel for num_threads(simulation->team.size) if (simulation->team.size > 1)
    for (ptrdiff_t first = 0; first < a->n; first += BATCH_MAX) {
        const int len = (int)(a->n - first < BATCH_MAX ? a->n - first : BATCH_MAX);
        struct places at;
        for (int i = 0; i < len; i++) {
            const int own = (int)a->level[first + i];
            at.s[i] = s[own];
            at.half[i] = half[own];
            at.active[i] = own == level ? 1 : 0;
        }
        (a->dim == 2 ? predict_2 : predict_3)(simulation, first, len, &at);
    }
}

/* --- evaluation ------------------------------------------------------------------------------- */

/* Sets the mean rates of the current step of active particles: rates of their own pairs, plus
 * impulses of finer pairs in the first half. */
static void find_mean_rates(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    const struct steps_clock *clock = &simulation->steps.clock;
    const int level = simulation->steps.level;
    const double inverse = 1 / (0.5 * clock->tick * (double)length_of(clock, level));
    for (ptrdiff_t i = 0; i < a->n; i++) {
        if ((int)a->level[i] > level) continue;
        a->pace[i] = pace_of(a, i);
        if ((int)a->level[i] < level) continue;
        simulation->steps.updates++;
        for (int k = 0; k < a->dim; k++) a->F_mean[k][i] = a->F[k][i] + a->impulse[k][i] * inverse;
        a->de_mean[i] = a->de[i] + a->heat[i] * inverse;
    }
}

static enum status evaluate_level(struct simulation *simulation, int level, struct error *error)
{
    struct steps *steps = &simulation->steps;
    steps->level = level;
    steps->span = steps->clock.tick * (double)length_of(&steps->clock, level);
    predict(simulation);
    const enum status status = evaluate_rates_of_primitives(simulation, error);
    if (!status) find_mean_rates(simulation);
    steps->level = -1;
    return status;
}

void steps_begin_sums(struct simulation *simulation)
{
    const struct particles *a = &simulation->particles;
    for (ptrdiff_t i = 0; i < a->n; i++)
        if (simulation_evaluates(simulation, i)) a->h_inverse_old[i] = a->h_inverse_found[i];
}

/* --- steps ------------------------------------------------------------------------------------ */

/* Moves a particle by dt, to the end of its step, with its own rates over the time `own` and the
 * mean of all impulses over the time `all`. Returns its internal energy. */
static double end_step(const struct simulation *simulation, double dt, double own, double all,
                       ptrdiff_t i)
{
    const struct particles *a = &simulation->particles;
    const double kinetic = simulation->scheme.energy == ENERGY_TOTAL ? 0.5 : 0, inverse = 1 / all,
                 share = own == all ? 1 : own * inverse;
    a->e[i] = a->e[i] + a->de[i] * own + a->heat[i];
    a->de_mean[i] = a->de[i] * share + a->heat[i] * inverse;
    a->heat[i] = 0;
    double U = a->e[i];
    for (int k = 0; k < a->dim; k++) {
        const double p = a->p[k][i], p_now = p + a->F[k][i] * own + a->impulse[k][i];
        a->x_old[k][i] = a->x[k][i] = a->x_old[k][i] + 0.5 * (p + p_now) * a->m_inverse[i] * dt;
        a->p[k][i] = p_now;
        a->F_mean[k][i] = a->F[k][i] * share + a->impulse[k][i] * inverse;
        a->impulse[k][i] = 0;
        U -= kinetic * p_now * (p_now * a->m_inverse[i]);
    }
    return U;
}

/* Completes the steps that end at the current tick, and chooses the next levels of their particles.
 */
static enum status end_steps(struct simulation *simulation, double block, struct error *error)
{
    const struct particles *a = &simulation->particles;
    const struct steps_clock *clock = &simulation->steps.clock;
    const int coarsest = coarsest_at(clock);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const int level = (int)a->level[i];
        if (level < coarsest) continue;
        const double dt = clock->tick * (double)length_of(clock, level),
                     U = end_step(simulation, dt, dt, dt, i);
        if (!(U > 0)) return breakdown_of(simulation, i, "internal energy", U, error);
        a->span[i] = simulation->steps.depth > 0 ? 0.5 * (a->before[i] + dt) : dt;
        a->before[i] = dt;
        const int next = level_for(simulation, a->pace[i], block, simulation->steps.depth);
        a->level[i] = next > coarsest ? next : coarsest;
    }
    return STATUS_OK;
}

/* --- waking ----------------------------------------------------------------------------------- */

/* began: start of the level's step that contains the start of the active particles' step. covered:
 * time up to which the level's pairs had given their impulses by then. */
static long began(const struct steps *steps, int level)
{
    const long then = steps->clock.now - length_of(&steps->clock, steps->level) / 2;
    return then - then % length_of(&steps->clock, level);
}

static long covered(const struct steps *steps, int level)
{
    const long then = began(steps, steps->level), length = length_of(&steps->clock, level);
    return began(steps, level) + (2 * (then % length) >= length ? length : 0);
}

int steps_woken_level(const struct simulation *simulation)
{
    return simulation->steps.level - 1;
}

bool steps_uncovered(const struct simulation *simulation, double *spans)
{
    const struct steps *steps = &simulation->steps;
    const int to = steps_woken_level(simulation);
    bool some = false;
    for (int level = 0; level < to; level++) {
        const long missing = covered(steps, to) - covered(steps, level);
        spans[level] = steps->clock.tick * (double)missing;
        some |= missing != 0;
    }
    return some;
}

/* Ends the step of a woken particle where its new step has begun. Returns its internal energy. */
static double wake(const struct simulation *simulation, int to, ptrdiff_t i)
{
    const struct particles *a = &simulation->particles;
    const struct steps *steps = &simulation->steps;
    const int level = (int)a->level[i];
    const double tick = steps->clock.tick;
    const long start = began(steps, level), end = began(steps, to);
    const double dt = tick * (double)(end - start),
                 given = tick * (double)(covered(steps, level) - start),
                 mean_of = tick * (double)(covered(steps, to) - start);
    double U = a->U[i];
    if (dt > 0) {
        U = end_step(simulation, dt, given, mean_of, i);
        /* the time since the last density sum is that of a last step of this length */
        if (given > 0) a->span[i] = 0.5 * (a->before[i] + given);
        a->before[i] = given > 0 ? 2 * dt - given : a->before[i] + 2 * dt;
    }
    /* pairs whose midpoint has passed have been corrected */
    for (int k = 0; k < a->dim; k++) a->F[k][i] = 0;
    a->de[i] = 0;
    a->level[i] = to;
    return U;
}

enum status steps_wake(struct simulation *simulation, const unsigned char *woken,
                       struct error *error)
{
    for (ptrdiff_t i = 0; i < simulation->particles.n; i++) {
        if (!woken[i]) continue;
        simulation->steps.woken++;
        const double U = wake(simulation, woken[i], i);
        if (!(U > 0)) return breakdown_of(simulation, i, "internal energy", U, error);
    }
    predict(simulation);
    return STATUS_OK;
}

/* --- blocks ----------------------------------------------------------------------------------- */

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
    struct steps_clock *clock = &steps->clock;
    *clock = (struct steps_clock){.finest = steps->depth + STEPS_SPARE};
    clock->end = 2L << clock->finest;
    clock->tick = dt / (double)clock->end;
    steps->updates = 0;
    for (ptrdiff_t i = 0; i < a->n; i++)
        a->level[i] = level_for(simulation, a->pace[i], dt, steps->depth);
    while (clock->now < clock->end) {
        clock->now += length_of(clock, finest_of(a)) / 2;
        enum status status = STATUS_OK;
        if (coarsest_at(clock) <= finest_of(a)) status = end_steps(simulation, dt, error);
        const int level = middle_at(clock);
        if (!status && clock->now < clock->end && has_level(a, level))
            status = evaluate_level(simulation, level, error);
        if (status) return status;
    }
    double rate = 0;
    for (ptrdiff_t i = 0; i < a->n; i++) rate = largest(rate, a->signal[i] * a->h_inverse[i]);
    simulation->time_step = simulation->scheme.cfl / rate;
    simulation->sleep.awake_count = a->n;
    return STATUS_OK;
}
