/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "range.h"

#include <math.h>

#include "loop.h"

CLONES double range_primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
                               double kinetic)
{
    const double *restrict p = particles->p + first, *restrict e = particles->e + first,
                           *restrict m_inverse = particles->m_inverse + first;
    double *restrict v = particles->v + first, *restrict U = particles->U + first;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = 0; i < len; i++) {
        v[i] = p[i] * m_inverse[i];
        U[i] = e[i] - kinetic * p[i] * v[i];
        unsound += U[i] > 0 ? 0. : 1.;
    }
    return unsound;
}

CLONES double range_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len)
{
    const double *restrict x = particles->x + first;
    double crossings = 0;
#pragma omp simd reduction(+ : crossings)
    for (ptrdiff_t i = 0; i < len; i++) crossings += x[i] <= x[i + 1] ? 0. : 1.;
    return crossings;
}

CLONES double range_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d)
{
    const double *restrict x = particles->x + first, *restrict h = particles->h + first;
    double inside = 0;
#pragma omp simd reduction(+ : inside)
    for (int i = 0; i < len; i++)
        inside += least(x[i + d] - x[i], x[i] - x[i - d]) < h[i] ? 1. : 0.;
    return inside;
}

CLONES void range_predict_width(const struct particles *particles, ptrdiff_t first, int len,
                                double eta, double ratio)
{
    const double *restrict rho = particles->rho_sum + first, *restrict m_inverse =
                                                                 particles->m_inverse + first;
    double *restrict h = particles->h + first, *restrict h_inverse = particles->h_inverse + first,
                     *restrict last = particles->h_inverse_old + first;
    const double eta_inverse = 1 / eta;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double now = rho[i] * m_inverse[i] * eta_inverse;
        const double next = now + ratio * (now - last[i]);
        h_inverse[i] = largest(0.5 * now, least(2 * now, next));
        h[i] = 1 / h_inverse[i];
        last[i] = now;
    }
}

ALWAYS_INLINE void close_body(const struct particles *particles, ptrdiff_t first, int len,
                              bool energy_sum, bool standard, double constant, double gamma,
                              const struct density_sums *restrict sums)
{
    const double *restrict m = particles->m + first, *restrict U = particles->U + first,
                           *restrict h_inverse = particles->h_inverse + first,
                           *restrict m_inverse = particles->m_inverse + first;
    double *restrict rho_sum = particles->rho_sum + first, *restrict y = particles->y + first,
                     *restrict V = particles->V + first, *restrict rho = particles->rho + first,
                     *restrict P = particles->P + first, *restrict c = particles->c + first,
                     *restrict g = particles->g + first;
    const double c2 = gamma * (gamma - 1);
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double scale = constant * h_inverse[i], sum = scale * sums->m[i];
        rho_sum[i] = sum;
        if (energy_sum) {
            y[i] = scale * sums->Z[i];
            V[i] = U[i] / y[i];
            rho[i] = m[i] / V[i];
            P[i] = (gamma - 1) * y[i];
        } else {
            y[i] = sum;
            V[i] = m[i] / sum;
            rho[i] = sum;
            P[i] = (gamma - 1) * sum * U[i] * m_inverse[i];
        }
        c[i] = sqrt(c2 * U[i] * m_inverse[i]);
        if (standard) g[i] = scale * h_inverse[i];
    }
}

CLONES static void close_mass(const struct particles *particles, ptrdiff_t first, int len,
                              bool standard, double constant, double gamma,
                              const struct density_sums *sums)
{
    if (standard)
        close_body(particles, first, len, false, true, constant, gamma, sums);
    else
        close_body(particles, first, len, false, false, constant, gamma, sums);
}

void range_close(const struct particles *particles, ptrdiff_t first, int len,
                 const struct plan *plan, double constant, double gamma,
                 const struct density_sums *sums)
{
    if (plan->energy_sum)
        close_body(particles, first, len, true, !plan->matrix, constant, gamma, sums);
    else
        close_mass(particles, first, len, !plan->matrix, constant, gamma, sums);
    if (!plan->grad_h) return;
    double *restrict factor = particles->grad_h + first, *restrict b = particles->b + first;
    const double *restrict V = particles->V + first, *restrict P = particles->P + first,
                           *restrict y = particles->y + first;
    for (int i = 0; i < len; i++) {
        /* h/rho drho/dh = -m_dh/m, so f = 1/(1 - m_dh/m); with the energy element
         * f_ij = 1 - (m_j/Z_j) factor_i (Hopkins 2013), with the mass element f_i = 1 - factor_i */
        const double dh = plan->energy_sum ? sums->Z_dh[i] : sums->m_dh[i];
        factor[i] = -dh / (sums->m[i] - sums->m_dh[i]);
        b[i] = V[i] * P[i] / y[i];
    }
}

CLONES double range_rate(const struct particles *particles, ptrdiff_t first, int len)
{
    const double *restrict signal = particles->signal + first, *restrict h_inverse =
                                                                   particles->h_inverse + first;
    double lane[8] = {0}; /* a maximum a lane: clang does not vectorise reduction(max) */
    int i = 0;
    for (; i + 8 <= len; i += 8)
#pragma omp simd
        for (int k = 0; k < 8; k++) lane[k] = largest(signal[i + k] * h_inverse[i + k], lane[k]);
    for (; i < len; i++) lane[0] = largest(signal[i] * h_inverse[i], lane[0]);
    for (int k = 1; k < 8; k++) lane[0] = largest(lane[0], lane[k]);
    return lane[0];
}
