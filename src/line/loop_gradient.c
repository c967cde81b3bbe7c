/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients of the pairs (i, i+d) in 1D, the only part of the pair force that evaluates the kernel.
 * With j right of i, r = x_j - x_i >= 0 and the component of grad_i W is positive:
 * standard: -C/h^2 w'(r/h), ia: g r w(r/h), g = 1/sum V x^2 w (CONVENTIONS eqs. 4.1 and 4.3). */
#include <math.h>

#include "family_names.h"
#include "loops.h"
#include "specialise.h"

ALWAYS_INLINE double own_gradient(const struct kernel *kernel, kernel_shape *w, kernel_shape *dw,
                                  enum gradient gradient, double g, double r, double h_inverse)
{
    const double q = r * h_inverse;
    const enum gradient_weight weight = gradient_of[gradient].weight;
    if (weight == WEIGHT_NONE) return -g * dw(kernel, q, 1);
    const double shape = weight == WEIGHT_SLOPE ? 0 : w(kernel, q, 1);
    const double slope = weight > WEIGHT_W && q > 0 ? -dw(kernel, q, 1) / q : 0;
    return g * (r * gradient_weight(gradient, shape, slope));
}

ALWAYS_INLINE void gradients_of_pairs(const struct kernel *kernel, kernel_shape *w,
                                      kernel_shape *dw, enum gradient gradient, int width,
                                      const struct particles *particles, ptrdiff_t first, int pairs,
                                      ptrdiff_t d, double *restrict G, double *restrict G_j)
{
    const double *restrict x = particles->x[0] + first, *restrict g = particles->g + first,
                           *restrict h_inverse = particles->h_inverse + first;
    const double constant = kernel->constant[1];
    const int count = whole_vectors(pairs);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const ptrdiff_t j = i + d;
        const double r = x[j] - x[i];
        if (width == PAIR_WIDTH_MEAN || width == PAIR_WIDTH_OWN) {
            const double at_i = own_gradient(kernel, w, dw, gradient, g[i], r, h_inverse[i]);
            const double at_j = own_gradient(kernel, w, dw, gradient, g[j], r, h_inverse[j]);
            if (width == PAIR_WIDTH_OWN) {
                G[i] = at_i;
                G_j[i] = at_j;
            } else {
                G[i] = 0.5 * (at_i + at_j);
            }
        } else {
            const double inverse = width == PAIR_WIDTH_MAX ? least(h_inverse[i], h_inverse[j])
                                                           : 0.5 * (h_inverse[i] + h_inverse[j]);
            const double scale = gradient_of[gradient].weight == WEIGHT_NONE
                                     ? constant * (inverse * inverse)
                                     : 0.5 * (g[i] + g[j]);
            G[i] = own_gradient(kernel, w, dw, gradient, scale, r, inverse);
        }
    }
}

#define BODY(function, w, dw, gradient, width, attributes)                                         \
    attributes static void function(const struct kernel *kernel,                                   \
                                    const struct particles *particles, ptrdiff_t first, int pairs, \
                                    ptrdiff_t d, double *G, double *G_j)                           \
    {                                                                                              \
        if (gradient_of[gradient].least_dim > 1) return;                                           \
        gradients_of_pairs(kernel, w, dw, gradient, width, particles, first, pairs, d, G, G_j);    \
    }

/* Expands X for every gradient and pair width, for one kernel k. */
#define AT_WIDTHS(g, name, X, k)                     PAIR_WIDTH_LIST(AT_WIDTH, X, k, g) X(k, g, PAIR_WIDTH_OWN)
#define AT_WIDTH(width, name, label, paper, X, k, g) X(k, g, width)
#define ALL(X, k)                                    GRADIENT_LIST(AT_WIDTHS, X, k)

#define ENTRY(k, g, width) [g][width] = k##_##g##_##width,

#ifdef KERNEL_FILE

#define SPECIALISE(k, g, width) BODY(k##_##g##_##width, k##_w, k##_dw, g, width, CLONES)
#define KERNEL(name, ...)                                                                          \
    ALL(SPECIALISE, name)                                                                          \
    gradient_loop *const loop_gradient_##name[GRADIENTS][PAIR_GRADIENTS] = {ALL(ENTRY, name)};
#include KERNEL_FILE

#else

#define UNSTAMPED(k, g, width) BODY(k##_##g##_##width, kernel->w, kernel->dw, g, width, )
ALL(UNSTAMPED, any)

static gradient_loop *const generic[GRADIENTS][PAIR_GRADIENTS] = {ALL(ENTRY, any)};

#define DECLARE(name) extern gradient_loop *const loop_gradient_##name[GRADIENTS][PAIR_GRADIENTS];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   loop_gradient_##name,
static gradient_loop *const (*const specialised[])[PAIR_GRADIENTS] = {KERNEL_NAMES(TABLE)};

gradient_loop *loop_gradient(int kernel, enum gradient gradient, int width)
{
    return kernel < 0 ? generic[gradient][width] : specialised[kernel][gradient][width];
}

#endif
