/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_loops.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

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
        a->x[i] = (double)i + jitter * (2 * gsl_rng_uniform(rng) - 1);
        a->m[i] = a->V[i] = a->m_inverse[i] = a->rho[i] = 1;
        a->v[i] = 0.1 * sin(phase);
        a->U[i] = 2.5 * (1 + 0.1 * cos(phase));
        a->P[i] = (gamma_gas - 1) * a->U[i];
        a->c[i] = sqrt(gamma_gas * a->P[i]);
        a->h[i] = scheme->eta;
        a->h_inverse[i] = 1 / scheme->eta;
        a->alpha[i] = scheme->alpha;
        a->b[i] = a->P[i];
        a->g[i] = C_1 * a->h_inverse[i] * a->h_inverse[i];
        a->dv[i] = 0.1 * cos(phase);
    }
    gsl_rng_free(rng);
    double *const all[] = {a->m, a->V, a->rho,       a->v,     a->U, a->P, a->c,
                           a->h, a->b, a->h_inverse, a->alpha, a->g, a->dv};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        particles_fill_ghosts(a, all[k], a->ghosts, 0);
    particles_fill_ghosts(a, a->x, a->ghosts, a->period);
}

static void run(struct bench_loops *loops, unsigned passes)
{
    const struct particles *a = &loops->particles;
    const struct kernel *kernel = &loops->scheme.kernel;
    struct density_sums sums;
    for (ptrdiff_t first = 0; first < a->n; first += RANGE_MAX) {
        const int len = (int)(a->n - first < RANGE_MAX ? a->n - first : RANGE_MAX);
        if (passes & 1u << PASS_DENSITY) {
            loops->loops.density(kernel, a, first, len, loops->reach, a->h_inverse + first, &sums);
            for (int i = 0; i < len; i++) a->h_inverse_found[first + i] = sums.m[i];
        }
        if (passes & 1u << PASS_MATRIX) loops->loops.matrix(kernel, a, first, len, loops->reach);
    }
    for (ptrdiff_t first = 0; first < a->n; first += RANGE_MAX) {
        const int len = (int)(a->n - first < RANGE_MAX ? a->n - first : RANGE_MAX);
        if (passes & 1u << PASS_FORCE)
            loops->loops.force(&loops->loops, &loops->numbers, a, first, len, loops->reach,
                               loops->scratch);
        if (passes & 1u << PASS_SIGNAL) loops_signal(a, first, len, loops->reach);
    }
}

enum status bench_loops_create(struct bench_loops *loops, const struct scheme *scheme, size_t n,
                               bool stamped, unsigned passes, struct error *error)
{
    *loops = (struct bench_loops){.scheme = *scheme, .passes = passes};
    loops_choose(&loops->scheme, stamped, &loops->loops, &loops->numbers);
    if (!loops->loops.matrix) loops->passes &= ~(1u << PASS_MATRIX);
    loops->reach = (ptrdiff_t)ceil(scheme->eta) - 1;
    if (loops->reach < 1) loops->reach = 1;
    const enum status status = particles_create(&loops->particles, (ptrdiff_t)n, GHOSTS, error);
    if (status) return status;
    loops->particles.period = (double)n;
    loops->scratch = malloc(force_scratch(loops->reach) * sizeof(double));
    if (!loops->scratch) return error_set(error, STATUS_ENVIRONMENT, "no memory");
    fill(loops);
    static const uint64_t directed[] = {
        [PASS_DENSITY] = 2, [PASS_MATRIX] = 2, [PASS_FORCE] = 1, [PASS_SIGNAL] = 2};
    for (unsigned pass = PASS_DENSITY; pass <= PASS_SIGNAL; pass++)
        if (loops->passes & 1u << pass) loops->pairs += directed[pass] * n * (size_t)loops->reach;
    return STATUS_OK;
}

void bench_loops_free(struct bench_loops *loops)
{
    particles_destroy(&loops->particles);
    free(loops->scratch);
    loops->scratch = NULL;
}

enum status bench_loops_work(void *context, uint64_t times, struct bench_taken *taken,
                             struct error *error)
{
    struct bench_loops *loops = context;
    (void)error;
    const struct bench_taken start = bench_now();
    for (uint64_t i = 0; i < times; i++) run(loops, loops->passes);
    bench_add(taken, &start);
    return STATUS_OK;
}
