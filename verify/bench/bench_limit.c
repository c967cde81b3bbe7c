/* SPDX-License-Identifier: GPL-3.0-or-later
 * One pass over the neighbours: sums of V p f, V p, V p (x) x with p = x w or (x/q) dw/dq, and for
 * the normalised kernel also those of V w, V w f, V w x, into which its gradient separates. */
#include "bench_limit.h"

#include <math.h>

#include "family_names.h"
#include "specialise.h"
#include "matrix.h"

/* Offsets of the sums. */
enum { PF = 0, P = 3, PX = 6, W = 15, WF = 16, WX = 17, USED = 20 };

/* The kinds of sums that the operators need: with a matrix if the pair vector is not the gradient,
 * and a further kind, CORRECTED, with a matrix. */
enum { CORRECTED = PAIR_VECTORS };
#define DIMENSIONS(vector, tag, X, name)                                                           \
    X(name, tag, vector, 1) X(name, tag, vector, 2) X(name, tag, vector, 3)
#define KINDS(X, name) VECTOR_LIST(DIMENSIONS, X, name) DIMENSIONS(CORRECTED, corrected, X, name)

#ifdef KERNEL_FILE /* one kernel's, see specialise.c.in */

ALWAYS_INLINE void sum_up(const struct kernel *kernel, kernel_shape *w, kernel_shape *dw,
                          int vector, int dim, const struct bench_neighbours *list,
                          double *restrict sums)
{
    const bool matrix = vector != VECTOR_GRADIENT;
    const double *restrict x0 = list->x[0], *restrict x1 = list->x[1], *restrict x2 = list->x[2],
                           *restrict volume = list->volume, *restrict f = list->f;
    enum { LANES = 8 };
    double lane[USED][LANES] = {{0}};
    for (size_t begin = 0; begin < list->n; begin += LANES)
#pragma omp simd
        for (int k = 0; k < LANES; k++) {
            const size_t m = begin + (size_t)k;
            const double x[3] = {x0[m], dim > 1 ? x1[m] : 0, dim > 2 ? x2[m] : 0};
            const double q = dim == 1   ? fabs(x[0])
                             : dim == 2 ? sqrt(x[0] * x[0] + x[1] * x[1])
                                        : sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
            const double V = volume[m], Vf = V * f[m];
            const double shape = vector == VECTOR_GRADIENT ? 0 : w(kernel, q, dim);
            const double factor = vector == VECTOR_POSITION ? shape
                                  : q > 0                   ? -dw(kernel, q, dim) / q
                                                            : 0;
            for (int a = 0; a < dim; a++) {
                const double p = factor * x[a];
                lane[PF + a][k] += Vf * p;
                lane[P + a][k] += V * p;
                for (int b = 0; b < dim && matrix; b++) lane[PX + 3 * a + b][k] += V * p * x[b];
            }
            if (vector == VECTOR_NORMALISED) {
                lane[W][k] += V * shape;
                lane[WF][k] += Vf * shape;
                for (int a = 0; a < dim; a++) lane[WX + a][k] += V * shape * x[a];
            }
        }
    for (int s = 0; s < USED; s++) {
        sums[s] = 0;
        for (int k = 0; k < LANES; k++) sums[s] += lane[s][k];
    }
}

#define BODY(name, tag, vector, dim)                                                               \
    CLONES static void name##_##tag##_##dim(const struct kernel *kernel,                           \
                                            const struct bench_neighbours *list, double *sums)     \
    {                                                                                              \
        sum_up(kernel, name##_w, name##_dw, vector, dim, list, sums);                              \
    }

#define ENTRY(name, tag, vector, dim) [vector][dim - 1] = name##_##tag##_##dim,
#define KERNEL(name, ...)                                                                          \
    KINDS(BODY, name)                                                                              \
    bench_limit_loop *const bench_limit_##name[PAIR_VECTORS + 1][KERNEL_DIM_MAX] = {               \
        KINDS(ENTRY, name)};
#include KERNEL_FILE

#else

#define DECLARE(name)                                                                              \
    extern bench_limit_loop *const bench_limit_##name[PAIR_VECTORS + 1][KERNEL_DIM_MAX];
KERNEL_NAMES(DECLARE)
#define TABLE(name) bench_limit_##name,
static bench_limit_loop *const (*const loops[])[KERNEL_DIM_MAX] = {KERNEL_NAMES(TABLE)};

bench_limit_loop *bench_limit_find(const struct kernel *kernel, const struct operator_form *form,
                                   int dim)
{
    const int specialisation = kernel_specialisation(kernel);
    size_t kind = form->pair_vector;
    if (form->corrected && kind == VECTOR_GRADIENT) kind = CORRECTED;
    return specialisation < 0 ? NULL : loops[specialisation][kind][dim - 1];
}

CLONES static size_t near(int dim, size_t n, const float *restrict x, const float *restrict y,
                          const float *restrict z)
{
    enum { LANES = 64 };
    int32_t found[LANES] = {0};
    size_t sum = 0;
    for (size_t begin = 0; begin < n; begin += LANES)
#pragma omp simd
        for (size_t k = 0; k < LANES; k++) {
            const size_t m = begin + k;
            const float plane = x[m] * x[m] + y[m] * y[m];
            found[k] += (dim == 3 ? plane + z[m] * z[m] : plane) < 1;
        }
    for (size_t k = 0; k < LANES; k++) sum += (size_t)found[k];
    return sum;
}

size_t bench_limit_near(int dim, size_t n, const float *const x[3])
{
    return dim == 3 ? near(3, n, x[0], x[1], x[2]) : near(2, n, x[0], x[1], x[1]);
}

double bench_limit_candidates(int dim)
{
    return dim == 3 ? 27 / (4 * M_PI / 3) : 9 / M_PI;
}

bool bench_limit_gradient(const struct kernel *kernel, const struct operator_form *form, int dim,
                          const double *sums, double f_0, double h, double *gradient)
{
    const bool normalised = form->pair_vector == VECTOR_NORMALISED;
    double pf[3] = {0}, matrix[9] = {0}, inverse[9];
    for (int a = 0; a < dim; a++) {
        const double mean = normalised ? sums[P + a] / sums[W] : 0;
        pf[a] = sums[PF + a] - mean * sums[WF];
        /* normalised vectors sum to zero, so the difference costs nothing */
        if (form->difference) pf[a] -= f_0 * (sums[P + a] - mean * sums[W]);
        for (int b = 0; b < dim; b++)
            matrix[a * dim + b] = sums[PX + 3 * a + b] - mean * sums[WX + b];
    }
    if (!form->corrected) {
        for (int a = 0; a < dim; a++) gradient[a] = pf[a] * kernel->constant[dim] / h;
        return true;
    }
    if (!matrix_invert(dim, matrix, inverse)) return false;
    for (int a = 0; a < dim; a++) {
        gradient[a] = 0;
        for (int b = 0; b < dim; b++) gradient[a] += inverse[a * dim + b] * pf[b] / h;
    }
    return true;
}

#endif
