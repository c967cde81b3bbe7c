/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bench_cells.h"

#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>

#include "description.h"
#include "plan.h"

static const double jitter = 0.2, gamma_gas = 1.4;

/* The sums as the solver requests them (src/cells/workspace.c). */
static struct cells_method method_of(const struct scheme *s, int dim, bool specialised)
{
    const struct plan plan = plan_make(s, dim, false, specialised);
    struct cells_method method = cells_method_of(s, &plan);
    method.box = (struct grid_box){.dim = dim, .hi = {1, 1, 1}, .periodic = {true, true, true}};
    method.threads = 1;
    return method;
}

/* Input and output arrays. */
struct arrays {
    double *x[3], *v[3], *m, *U, *alpha, *balsara, *h_inverse, *P, *c, *rho, *V, *b, *grad_h;
};

static bool allocate(struct bench_cells *bench, size_t n, struct arrays *of)
{
    struct cells_fields *f = &bench->fields;
    double **const read[] = {&of->x[0], &of->x[1],   &of->x[2],     &of->v[0],      &of->v[1],
                             &of->v[2], &of->m,      &of->U,        &of->alpha,     &of->balsara,
                             &of->P,    &of->c,      &of->rho,      &of->h_inverse, &of->V,
                             &of->b,    &of->grad_h, &bench->radius};
    double **const found[] = {
        &f->sum_m,       &f->sum_m_dh,    &f->sum_Z,        &f->sum_Z_dh,     &f->condition,
        &f->F[0],        &f->F[1],        &f->F[2],         &f->de,           &f->div_v,
        &f->signal,      &f->alpha_local, &f->decay,        &f->steep,        &f->dm,
        &f->shift[0],    &f->shift[1],    &f->shift[2],     &f->de_shift,     &f->dp_shift[0],
        &f->dp_shift[1], &f->dp_shift[2], &f->potential[0], &f->potential[1], &f->potential[2]};
    enum { READ = sizeof read / sizeof *read, FOUND = sizeof found / sizeof *found };
    const size_t stride = n + 16; /* vector loads read beyond the end */
    double *next = bench->storage =
        calloc((READ + FOUND + CELLS_SYMMETRIC + CELLS_SQUARE) * stride, sizeof *next);
    if (!next) return false;
    for (size_t k = 0; k < READ; k++, next += stride) *read[k] = next;
    for (size_t k = 0; k < FOUND; k++, next += stride) *found[k] = next;
    for (size_t k = 0; k < CELLS_SYMMETRIC; k++, next += stride) f->matrix[k] = next;
    for (size_t k = 0; k < CELLS_SQUARE; k++, next += stride) f->slope[k] = next;
    f->n = n;
    for (int a = 0; a < 3; a++) f->x[a] = of->x[a], f->v[a] = of->v[a];
    f->m = of->m, f->U = of->U, f->alpha = of->alpha, f->balsara = of->balsara;
    f->h_inverse = of->h_inverse, f->P = of->P, f->c = of->c, f->rho = of->rho, f->V = of->V;
    f->b = of->b, f->grad_h = of->grad_h;
    return true;
}

static void fill(const struct bench_cells *bench, const struct arrays *of, int dim, size_t side)
{
    const double n = (double)bench->fields.n, h = bench->scheme.eta / (double)side;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (size_t i = 0; i < bench->fields.n; i++) {
        size_t rest = i;
        for (int a = 0; a < dim; a++, rest /= side) {
            const double away = 0.5 + jitter * (gsl_rng_uniform(rng) - 0.5);
            of->x[a][i] = ((double)(rest % side) + away) / (double)side;
            of->v[a][i] = 0.1 * sin(2 * M_PI * (of->x[a][i] + of->x[0][i]));
        }
        of->m[i] = of->V[i] = 1 / n;
        of->rho[i] = of->balsara[i] = 1;
        of->U[i] = 2.5 * (1 + 0.1 * cos(2 * M_PI * of->x[0][i])) / n;
        of->P[i] = (gamma_gas - 1) * of->U[i] * n;
        of->c[i] = sqrt(gamma_gas * of->P[i]);
        of->b[i] = of->P[i] / n;
        of->alpha[i] = bench->scheme.alpha;
        of->h_inverse[i] = 1 / h;
        bench->radius[i] = h;
    }
    gsl_rng_free(rng);
}

static enum status run(struct bench_cells *bench, unsigned passes, struct error *error)
{
    const struct cells_fields *fields = &bench->fields;
    if (passes & CELLS_SEARCH) {
        const enum status status = cells_arrange(bench->cells, fields, bench->radius, NULL, error);
        if (status) return status;
    }
    if (passes & CELLS_DENSITY) cells_density(bench->cells, fields);
    if (passes & CELLS_MATRIX) cells_matrix(bench->cells, fields);
    if (passes & CELLS_FORCE) bench->pairs = 2 * (double)cells_forces(bench->cells, fields);
    return STATUS_OK;
}

enum status bench_cells_create(struct bench_cells *bench, const struct scheme *scheme, int dim,
                               size_t side, bool specialised, unsigned passes, struct error *error)
{
    struct arrays arrays;
    const size_t n = dim == 2 ? side * side : side * side * side;
    *bench = (struct bench_cells){.scheme = *scheme, .passes = passes};
    const struct cells_method method = method_of(&bench->scheme, dim, specialised);
    bench->cells = cells_create(&method, n);
    if (!bench->cells || !allocate(bench, n, &arrays))
        return error_set(error, STATUS_ENVIRONMENT, "no memory for %zu particles", n);
    fill(bench, &arrays, dim, side);
    return run(bench, CELLS_EVALUATION, error);
}

void bench_cells_free(struct bench_cells *bench)
{
    cells_destroy(bench->cells);
    free(bench->storage);
    *bench = (struct bench_cells){0};
}

enum status bench_cells_work(void *context, uint64_t times, struct clock_taken *taken,
                             struct error *error)
{
    struct bench_cells *bench = context;
    enum status status = STATUS_OK;
    const struct clock_taken start = clock_now();
    for (uint64_t i = 0; i < times && !status; i++) status = run(bench, bench->passes, error);
    clock_add(taken, &start);
    return status;
}
