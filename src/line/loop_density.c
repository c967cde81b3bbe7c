/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kernel sums of density, smoothing length and grad-h (CONVENTIONS eqs. 3.1 and 3.9). */
#include <math.h>

#include "family_names.h"
#include "loops.h"
#include "specialise.h"

/* Sums over the pairs at offset d, on both sides. The first offset sets the sums to the particle's
 * own terms plus its pairs, further offsets add to them. */
ALWAYS_INLINE void pairs_at(bool add, ptrdiff_t d, const struct kernel *kernel, kernel_shape *w,
                            kernel_shape *dw, enum density_terms terms, const double *restrict x,
                            const double *restrict m, const double *restrict U, int count,
                            const double *restrict h_inverse, struct density_sums *restrict sums)
{
    const double w0 = w(kernel, 0, 1);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const double q_right = (x[i + d] - x[i]) * h_inverse[i];
        const double q_left = (x[i] - x[i - d]) * h_inverse[i];
        const double w_right = w(kernel, q_right, 1), w_left = w(kernel, q_left, 1);
        const double dh_right = w_right + q_right * dw(kernel, q_right, 1);
        const double dh_left = w_left + q_left * dw(kernel, q_left, 1);
        const double m_0 = m[i] * w0, Z_0 = U[i] * w0;
        sums->m[i] = (add ? sums->m[i] : m_0) + (m[i + d] * w_right + m[i - d] * w_left);
        sums->m_dh[i] = (add ? sums->m_dh[i] : m_0) + (m[i + d] * dh_right + m[i - d] * dh_left);
        if (terms == DENSITY_MASS) continue;
        sums->Z[i] = (add ? sums->Z[i] : Z_0) + (U[i + d] * w_right + U[i - d] * w_left);
        sums->Z_dh[i] = (add ? sums->Z_dh[i] : Z_0) + (U[i + d] * dh_right + U[i - d] * dh_left);
    }
}

ALWAYS_INLINE void sum_pairs(const struct kernel *kernel, kernel_shape *w, kernel_shape *dw,
                             enum density_terms terms, const struct particles *particles,
                             ptrdiff_t first, int len, ptrdiff_t D,
                             const double *restrict h_inverse, struct density_sums *restrict sums)
{
    const double *restrict x = particles->x[0] + first, *restrict m = particles->m + first,
                           *restrict U = particles->U + first;
    const int count = whole_vectors(len);
    pairs_at(false, 1, kernel, w, dw, terms, x, m, U, count, h_inverse, sums);
    for (ptrdiff_t d = 2; d <= D; d++)
        pairs_at(true, d, kernel, w, dw, terms, x, m, U, count, h_inverse, sums);
}

#define BODY(function, w, dw, terms, attributes)                                                   \
    attributes static void function(                                                               \
        const struct kernel *kernel, const struct particles *particles, ptrdiff_t first, int len,  \
        ptrdiff_t D, const double *h_inverse, struct density_sums *sums)                           \
    {                                                                                              \
        sum_pairs(kernel, w, dw, terms, particles, first, len, D, h_inverse, sums);                \
    }

#define ENTRY(terms, k) [terms] = k##_##terms,

#ifdef KERNEL_FILE

#define SPECIALISE(terms, k) BODY(k##_##terms, k##_w, k##_dw, terms, CLONES)
#define KERNEL(name, ...)                                                                          \
    DENSITY_LIST(SPECIALISE, name)                                                                 \
    density_loop *const loop_density_##name[DENSITY_TERMS] = {DENSITY_LIST(ENTRY, name)};
#include KERNEL_FILE

#else

#define UNSTAMPED(terms, k) BODY(k##_##terms, kernel->w, kernel->dw, terms, )
DENSITY_LIST(UNSTAMPED, any)

static density_loop *const generic[DENSITY_TERMS] = {DENSITY_LIST(ENTRY, any)};

#define DECLARE(name) extern density_loop *const loop_density_##name[DENSITY_TERMS];
KERNEL_NAMES(DECLARE)
#define TABLE(name)   loop_density_##name,
static density_loop *const *const specialised[] = {KERNEL_NAMES(TABLE)};

density_loop *loop_density(int kernel, enum density_terms terms)
{
    return kernel < 0 ? generic[terms] : specialised[kernel][terms];
}

#endif
