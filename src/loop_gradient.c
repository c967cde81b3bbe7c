/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gradients of the pairs (i, i+d) in 1D, the one part of the pair force that knows the kernel.
 * With j right of i, r = x_j - x_i >= 0 and the component of grad_i W is positive:
 * standard: -C/h^2 w'(r/h); ia: g r w(r/h), g = 1/sum V x^2 w. */
#include <math.h>

#include "loop.h"

ALWAYS_INLINE double own_gradient(const struct kernel *kernel, kernel_shape *w, kernel_shape *dw,
                                  enum gradient gradient, double g, double r, double h_inverse)
{
    return gradient == GRADIENT_IA ? g * (r * w(kernel, r * h_inverse, 1))
                                   : -g * dw(kernel, r * h_inverse, 1);
}

ALWAYS_INLINE void gradients_of_pairs(const struct kernel *kernel, kernel_shape *w,
                                      kernel_shape *dw, enum gradient gradient,
                                      enum pair_gradient form, const struct particles *particles,
                                      ptrdiff_t first, int pairs, ptrdiff_t d, double *restrict G,
                                      double *restrict G_j)
{
    const double *restrict x = particles->x + first, *restrict g = particles->g + first,
                           *restrict h_inverse = particles->h_inverse + first;
    const double constant = kernel->constant[1];
    const int count = whole_vectors(pairs);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const ptrdiff_t j = i + d;
        const double r = x[j] - x[i];
        if (form == PAIR_GRADIENT_MEAN || form == PAIR_GRADIENT_BOTH) {
            const double at_i = own_gradient(kernel, w, dw, gradient, g[i], r, h_inverse[i]);
            const double at_j = own_gradient(kernel, w, dw, gradient, g[j], r, h_inverse[j]);
            if (form == PAIR_GRADIENT_BOTH) {
                G[i] = at_i;
                G_j[i] = at_j;
            } else {
                G[i] = 0.5 * (at_i + at_j);
            }
        } else {
            const double inverse = form == PAIR_GRADIENT_MAX ? least(h_inverse[i], h_inverse[j])
                                                             : 0.5 * (h_inverse[i] + h_inverse[j]);
            const double scale =
                gradient == GRADIENT_IA ? 0.5 * (g[i] + g[j]) : constant * (inverse * inverse);
            G[i] = own_gradient(kernel, w, dw, gradient, scale, r, inverse);
        }
    }
}

#define BODY(function, w, dw, gradient, form, attributes)                                          \
    attributes static void function(const struct kernel *kernel,                                   \
                                    const struct particles *particles, ptrdiff_t first, int pairs, \
                                    ptrdiff_t d, double *G, double *G_j)                           \
    {                                                                                              \
        gradients_of_pairs(kernel, w, dw, gradient, form, particles, first, pairs, d, G, G_j);     \
    }

/* Every gradient in every form, for one kernel. */
#define FORMS(X, k, g)                                                                             \
    X(k, g, PAIR_GRADIENT_MEAN)                                                                    \
    X(k, g, PAIR_GRADIENT_MAX) X(k, g, PAIR_GRADIENT_HARMONIC) X(k, g, PAIR_GRADIENT_BOTH)
#define ALL(X, k) FORMS(X, k, GRADIENT_STANDARD) FORMS(X, k, GRADIENT_IA)

#define STAMP(k, g, f)    BODY(k##_##g##_##f, k##_w, k##_dw, g, f, CLONES)
#define KERNEL(name, ...) ALL(STAMP, name)
#include "kernels.def"
#undef KERNEL

#define UNSTAMPED(k, g, f) BODY(k##_##g##_##f, kernel->w, kernel->dw, g, f, )
ALL(UNSTAMPED, any)

#define ENTRY(k, g, f) [g][f] = k##_##g##_##f,
static gradient_loop *const stamped[][2][4] = {
#define KERNEL(name, ...) {ALL(ENTRY, name)},
#include "kernels.def"
#undef KERNEL
};
static gradient_loop *const unstamped[2][4] = {ALL(ENTRY, any)};

gradient_loop *loop_gradient(int kernel, enum gradient gradient, enum pair_gradient form)
{
    return kernel < 0 ? unstamped[gradient][form] : stamped[kernel][gradient][form];
}
