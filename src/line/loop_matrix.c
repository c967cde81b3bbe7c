/* SPDX-License-Identifier: GPL-3.0-or-later
 * The moment matrix of the gradient, in 1D the number T_i = sum_j V_j x^2 weight (ia: W), and the
 * linear_exact velocity gradient, whose weight is W (CONVENTIONS eqs. 4.3 and 4.4). C/h cancels
 * between matrix and gradient: g = 1/sum V x^2 w, G = g x w. */
#include <math.h>

#include "family_names.h"
#include "loops.h"
#include "specialise.h"

/* The weight of the matrix at q; w: w(q). */
ALWAYS_INLINE double weight_at(const struct kernel *kernel, kernel_shape *dw,
                               enum gradient gradient, double q, double w)
{
    const double slope = q > 0 ? -dw(kernel, q, 1) / q : 0;
    return gradient_weight(gradient, w, slope);
}

ALWAYS_INLINE void sum_moments(const struct kernel *kernel, kernel_shape *w, kernel_shape *dw,
                               enum gradient gradient, bool slopes,
                               const struct particles *particles, ptrdiff_t first, int len,
                               ptrdiff_t D)
{
    const enum gradient_weight weight = gradient_of[gradient].weight;
    const bool by_w = slopes || weight == WEIGHT_W, apart = weight > WEIGHT_W;
    const double *restrict x = particles->x[0] + first, *restrict V = particles->V + first,
                           *restrict v = particles->v[0] + first,
                           *restrict h_inverse = particles->h_inverse + first;
    double second[BATCH_MAX] = {0}, slope[BATCH_MAX] = {0}, own[BATCH_MAX] = {0};
    const int count = whole_vectors(len);
    for (ptrdiff_t d = 1; d <= D; d++) {
#pragma omp simd
        for (int i = 0; i < count; i++) {
            const double right = x[i + d] - x[i], left = x[i] - x[i - d];
            const double q_right = right * h_inverse[i], q_left = left * h_inverse[i];
            const double w_right = by_w || weight == WEIGHT_BOTH ? w(kernel, q_right, 1) : 0,
                         w_left = by_w || weight == WEIGHT_BOTH ? w(kernel, q_left, 1) : 0;
            const double right_w = V[i + d] * right * w_right, left_w = V[i - d] * left * w_left;
            if (by_w) second[i] += right_w * right + left_w * left;
            if (slopes) slope[i] += right_w * (v[i + d] - v[i]) + left_w * (v[i] - v[i - d]);
            if (!apart) continue;
            own[i] += V[i + d] * right * right * weight_at(kernel, dw, gradient, q_right, w_right) +
                      V[i - d] * left * left * weight_at(kernel, dw, gradient, q_left, w_left);
        }
    }
    double *restrict g = particles->g + first, *restrict dv = particles->dv + first;
    for (int i = 0; i < len; i++) {
        const double inverse = second[i] > 0 ? 1 / second[i] : 0; /* 0 without neighbours */
        if (weight == WEIGHT_W) g[i] = inverse;
        if (apart) g[i] = own[i] > 0 ? 1 / own[i] : 0;
        if (slopes) dv[i] = inverse * slope[i];
    }
}

/* Only for gradients that are defined in 1D; the standard one has no matrix. */
#define BODY(function, w, dw, gradient, slopes, attributes)                                        \
    attributes static void function(const struct kernel *kernel,                                   \
                                    const struct particles *particles, ptrdiff_t first, int len,   \
                                    ptrdiff_t D)                                                   \
    {                                                                                              \
        if (gradient_of[gradient].least_dim > 1) return;                                           \
        if (!slopes && gradient_of[gradient].weight == WEIGHT_NONE) return;                        \
        sum_moments(kernel, w, dw, gradient, slopes, particles, first, len, D);                    \
    }

/* Expands X for every gradient, without and with slopes, for one kernel k. */
#define BOTH(g, name, X, k) X(k, g, 0) X(k, g, 1)
#define ALL(X, k)           GRADIENT_LIST(BOTH, X, k)

#define ENTRY(k, g, slopes) [g][slopes] = k##_##g##_##slopes,

#ifdef KERNEL_FILE

#define SPECIALISE(k, g, slopes) BODY(k##_##g##_##slopes, k##_w, k##_dw, g, slopes, CLONES)
#define KERNEL(name, ...)                                                                          \
    ALL(SPECIALISE, name)                                                                          \
    matrix_loop *const loop_matrix_##name[GRADIENTS][2] = {ALL(ENTRY, name)};
#include KERNEL_FILE

#else

#define UNSTAMPED(k, g, slopes) BODY(k##_##g##_##slopes, kernel->w, kernel->dw, g, slopes, )
ALL(UNSTAMPED, any)

static matrix_loop *const generic[GRADIENTS][2] = {ALL(ENTRY, any)};

#define DECLARE(name) extern matrix_loop *const loop_matrix_##name[GRADIENTS][2];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   loop_matrix_##name,
static matrix_loop *const (*const specialised[])[2] = {KERNEL_NAMES(TABLE)};

matrix_loop *loop_matrix(int kernel, enum gradient gradient, bool slopes)
{
    return kernel < 0 ? generic[gradient][slopes] : specialised[kernel][gradient][slopes];
}

#endif
