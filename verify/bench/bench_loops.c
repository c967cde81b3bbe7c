/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_loops.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "integrator.h"
#include "specialise.h"
#include "state.h"

enum { GHOSTS = 64 };
static const double jitter = 0.02, gamma_gas = 1.4;

static void fill(struct bench_loops *loops)
{
    const struct particles *a = &loops->particles;
    const struct scheme *scheme = &loops->scheme;
    const double C_1 = scheme->kernel.constant[1];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (ptrdiff_t i = 0; i < a->n; i++) {
        const double phase = 2 * M_PI * (double)i / (double)a->n;
        a->x[0][i] = a->x_old[0][i] = (double)i + jitter * (2 * gsl_rng_uniform(rng) - 1);
        a->m[i] = a->V[i] = a->m_inverse[i] = a->rho[i] = 1;
        a->v[0][i] = 0.1 * sin(phase);
        a->U[i] = 2.5 * (1 + 0.1 * cos(phase));
        a->p[0][i] = a->m[i] * a->v[0][i];
        a->e[i] = a->U[i] + 0.5 * a->p[0][i] * a->v[0][i];
        a->P[i] = (gamma_gas - 1) * a->U[i];
        a->c[i] = sqrt(gamma_gas * a->P[i]);
        a->h[i] = scheme->eta;
        a->h_inverse[i] = a->h_inverse_found[i] = a->h_inverse_old[i] = 1 / scheme->eta;
        a->alpha[i] = scheme->alpha;
        a->b[i] = a->P[i];
        a->g[i] = C_1 * a->h_inverse[i] * a->h_inverse[i];
        a->dv[i] = 0.1 * cos(phase);
    }
    gsl_rng_free(rng);
    double *const all[] = {a->m, a->V, a->rho,       a->v[0],  a->U, a->P, a->c,
                           a->h, a->b, a->h_inverse, a->alpha, a->g, a->dv};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) ghosts_fill(a, all[k], a->ghosts, 0);
    ghosts_fill(a, a->x[0], a->ghosts, a->period[0]);
}

/* Moves particles like predicted_midpoint: to the end of a step and on to the middle of the
 * next. */
CLONES static void move(const struct particles *a, ptrdiff_t n, double dt)
{
    double *restrict x = a->x[0], *restrict x_old = a->x_old[0], *restrict v = a->v[0],
                     *restrict U = a->U, *restrict p = a->p[0], *restrict e = a->e;
    const double *restrict F = a->F[0], *restrict de = a->de, *restrict m_inverse = a->m_inverse;
#pragma omp simd
    for (ptrdiff_t i = 0; i < n; i++) {
        const double p_now = p[i] + F[i] * dt, e_now = e[i] + de[i] * dt;
        const double x_now = x_old[i] + 0.5 * (p[i] + p_now) * m_inverse[i] * dt;
        const double v_now = p_now * m_inverse[i], U_now = e_now - 0.5 * p_now * v_now;
        const double p_half = p_now + F[i] * dt, v_half = p_half * m_inverse[i];
        p[i] = p_now;
        e[i] = e_now;
        x_old[i] = x_now;
        x[i] = x_now + v_now * dt;
        v[i] = v_half;
        U[i] = largest(e_now + de[i] * dt - 0.5 * p_half * v_half, 0.5 * U_now);
    }
}

static double search(const struct particles *a, ptrdiff_t first, int len)
{
    ptrdiff_t reach = 1;
    while (reach_inside(a, first, len, reach + 1) > 0) reach++;
    return (double)reach;
}

static void run_range(struct bench_loops *loops, ptrdiff_t first, int len)
{
    const struct particles *a = &loops->particles;
    const struct kernel *kernel = &loops->scheme.kernel;
    const unsigned passes = loops->passes;
    const bool state = passes & 1u << PASS_STATE;
    struct density_sums sums;
    if (passes & 1u << PASS_REACH) loops->rate += reach_inside(a, first, len, loops->reach + 1);
    if (passes & 1u << PASS_SEARCH) loops->rate += search(a, first, len);
    if (state) width_predict(a, first, len, 1);
    if (passes & 1u << PASS_DENSITY) {
        loops->loops.density(kernel, a, first, len, loops->reach, a->h_inverse + first, &sums);
        const struct gas gas = {gamma_gas, kernel->constant[1], loops->scheme.eta,
                                loops->scheme.integrator->follow};
        if (state)
            state_close(a, first, len, &loops->plan, &gas, &sums);
        else
            memcpy(a->h_inverse_found + first, sums.m, (size_t)len * sizeof(double));
    }
    if (passes & 1u << PASS_MATRIX) loops->loops.matrix(kernel, a, first, len, loops->reach);
}

static void run(struct bench_loops *loops)
{
    const struct particles *a = &loops->particles;
    if (loops->passes & 1u << PASS_STATE) move(a, a->n, loops->dt);
    if (loops->passes & 1u << PASS_ORDER) loops->rate += order_crossings(a, 0, a->n - 1);
    if (loops->passes & 1u << PASS_SORT) loops->rate += order_sort(&loops->particles);
    for (ptrdiff_t first = 0; first < a->n; first += BATCH_MAX)
        run_range(loops, first, (int)(a->n - first < BATCH_MAX ? a->n - first : BATCH_MAX));
    for (ptrdiff_t first = 0; first < a->n; first += BATCH_MAX) {
        const int len = (int)(a->n - first < BATCH_MAX ? a->n - first : BATCH_MAX);
        if (loops->passes & 1u << PASS_FORCE)
            loops->rate +=
                loops->loops.force(&loops->loops, a, first, len, loops->reach, loops->scratch);
        if (loops->passes & 1u << PASS_SIGNAL) loops_signal(a, first, len, loops->reach);
    }
}

enum status bench_loops_create(struct bench_loops *loops, const struct scheme *scheme, size_t n,
                               bool specialised, unsigned passes, struct error *error)
{
    *loops = (struct bench_loops){.scheme = *scheme, .passes = passes};
    loops->plan = plan_make(&loops->scheme, 1, false, specialised);
    loops_choose(&loops->plan, &loops->scheme, &loops->loops);
    if (!loops->loops.matrix) loops->passes &= ~(1u << PASS_MATRIX);
    loops->reach = (ptrdiff_t)ceil(scheme->eta) - 1;
    if (loops->reach < 1) loops->reach = 1;
    const enum status status = particles_create(&loops->particles, 1, (ptrdiff_t)n, GHOSTS, error);
    if (status) return status;
    loops->particles.period[0] = (double)n;
    loops->scratch = malloc(loop_force_scratch(loops->reach) * sizeof(double));
    if (!loops->scratch) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    fill(loops);
    static const uint64_t directed[] = {[PASS_STATE] = 0,
                                        [PASS_DENSITY] = 2,
                                        [PASS_MATRIX] = 2,
                                        [PASS_FORCE] = 1,
                                        [PASS_SIGNAL] = 2};
    for (unsigned pass = PASS_STATE; pass <= PASS_SIGNAL; pass++)
        if (loops->passes & 1u << pass) loops->pairs += directed[pass] * n * (size_t)loops->reach;
    return STATUS_OK;
}

void bench_loops_free(struct bench_loops *loops)
{
    particles_destroy(&loops->particles);
    free(loops->scratch);
    loops->scratch = NULL;
}

enum status bench_loops_work(void *context, uint64_t times, struct clock_taken *taken,
                             struct error *error)
{
    struct bench_loops *loops = context;
    (void)error;
    const struct clock_taken start = clock_now();
    for (uint64_t i = 0; i < times; i++) run(loops);
    clock_add(taken, &start);
    return STATUS_OK;
}
