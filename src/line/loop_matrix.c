/* SPDX-License-Identifier: GPL-3.0-or-later
 * The moment matrix of the Integral Approach, in 1D the number T_i = sum_j V_j x^2 W, and with it
 * the linear_exact velocity gradient (CONVENTIONS eqs. 4.3 and 4.4). C/h cancels between
 * matrix and gradient: g = 1/sum V x^2 w, G = g x w. */
#include <math.h>

#include "kernel_names.h"
#include "loops.h"
#include "specialise.h"

ALWAYS_INLINE void sum_moments(const struct kernel *kernel, kernel_shape *w,
                               enum matrix_terms terms, const struct particles *particles,
                               ptrdiff_t first, int len, ptrdiff_t D)
{
    const bool reconstruct = terms != MATRIX_MOMENT;
    const double *restrict x = particles->x[0] + first, *restrict V = particles->V + first,
                           *restrict v = particles->v[0] + first,
                           *restrict h_inverse = particles->h_inverse + first;
    double second[BATCH_MAX] = {0}, slope[BATCH_MAX] = {0};
    const int count = whole_vectors(len);
    for (ptrdiff_t d = 1; d <= D; d++) {
#pragma omp simd
        for (int i = 0; i < count; i++) {
            const double right = x[i + d] - x[i], left = x[i] - x[i - d];
            const double right_w = V[i + d] * right * w(kernel, right * h_inverse[i], 1);
            const double left_w = V[i - d] * left * w(kernel, left * h_inverse[i], 1);
            second[i] += right_w * right + left_w * left;
            if (reconstruct) slope[i] += right_w * (v[i + d] - v[i]) + left_w * (v[i] - v[i - d]);
        }
    }
    double *restrict g = particles->g + first, *restrict dv = particles->dv + first;
    for (int i = 0; i < len; i++) {
        const double inverse = second[i] > 0 ? 1 / second[i] : 0; /* no neighbour: no gradient */
        if (terms != MATRIX_SLOPE) g[i] = inverse;
        if (reconstruct) dv[i] = inverse * slope[i];
    }
}

#define BODY(function, w, terms, attributes)                                                       \
    attributes static void function(const struct kernel *kernel,                                   \
                                    const struct particles *particles, ptrdiff_t first, int len,   \
                                    ptrdiff_t D)                                                   \
    {                                                                                              \
        sum_moments(kernel, w, terms, particles, first, len, D);                                   \
    }

#define ENTRY(terms, k) [terms] = k##_##terms,

#ifdef KERNEL_FILE

#define STAMP(terms, k) BODY(k##_##terms, k##_w, terms, CLONES)
#define KERNEL(name, ...)                                                                          \
    MATRIX_LIST(STAMP, name)                                                                       \
    matrix_loop *const loop_matrix_##name[MATRIX_TERMS] = {MATRIX_LIST(ENTRY, name)};
#include KERNEL_FILE

#else

#define UNSTAMPED(terms, k) BODY(k##_##terms, kernel->w, terms, )
MATRIX_LIST(UNSTAMPED, any)

static matrix_loop *const generic[MATRIX_TERMS] = {MATRIX_LIST(ENTRY, any)};

#define DECLARE(name) extern matrix_loop *const loop_matrix_##name[MATRIX_TERMS];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   loop_matrix_##name,
static matrix_loop *const *const specialised[] = {KERNEL_NAMES(TABLE)};

matrix_loop *loop_matrix(int kernel, enum matrix_terms terms)
{
    return kernel < 0 ? generic[terms] : specialised[kernel][terms];
}

#endif
