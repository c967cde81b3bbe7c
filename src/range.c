/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "range.h"

#include <math.h>

#include "loop.h"

/* Stamped functions are static here, and the public ones call them: clang 14 gives the dispatched
 * symbol a name of its own, so that another file would not find it. */

CLONES static double primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
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

CLONES static double crossings_in(const struct particles *particles, ptrdiff_t first, ptrdiff_t len)
{
    const double *restrict x = particles->x + first;
    double crossings = 0;
#pragma omp simd reduction(+ : crossings)
    for (ptrdiff_t i = 0; i < len; i++) crossings += x[i] <= x[i + 1] ? 0. : 1.;
    return crossings;
}

ALWAYS_INLINE double count_inside(const struct particles *particles, ptrdiff_t first, int len,
                                  ptrdiff_t d)
{
    const double *restrict x = particles->x + first, *restrict h_inverse =
                                                         particles->h_inverse + first;
    double inside = 0;
#pragma omp simd reduction(+ : inside)
    for (int i = 0; i < len; i++)
        inside += least(x[i + d] - x[i], x[i] - x[i - d]) * h_inverse[i] < 1 ? 1. : 0.;
    return inside;
}

CLONES static double inside_stamped(const struct particles *particles, ptrdiff_t first, int len,
                                    ptrdiff_t d)
{
    return len == RANGE_MAX ? count_inside(particles, first, RANGE_MAX, d)
                            : count_inside(particles, first, len, d);
}

ALWAYS_INLINE void predict_width(const struct particles *particles, ptrdiff_t first, int len,
                                 double ratio)
{
    const double *restrict found = particles->h_inverse_found + first;
    double *restrict h_inverse = particles->h_inverse + first, *restrict last =
                                                                   particles->h_inverse_old + first;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double next = found[i] + ratio * (found[i] - last[i]);
        h_inverse[i] = largest(0.5 * found[i], least(2 * found[i], next));
        last[i] = found[i];
    }
}

CLONES static void predict_stamped(const struct particles *particles, ptrdiff_t first, int len,
                                   double ratio)
{
    if (len == RANGE_MAX)
        predict_width(particles, first, RANGE_MAX, ratio);
    else
        predict_width(particles, first, len, ratio);
}

ALWAYS_INLINE double off_by(double ratio)
{
    return largest(ratio - 1, 1 - ratio);
}

/* A predicted width may be off by this part. */
static const double surprise_max = 0.3;

ALWAYS_INLINE double close_body(const struct particles *particles, ptrdiff_t first, int len,
                                bool energy_sum, bool own_gradient, const struct gas *gas,
                                const struct density_sums *restrict sums)
{
    const double *restrict m = particles->m + first, *restrict U = particles->U + first,
                           *restrict h_inverse = particles->h_inverse + first,
                           *restrict m_inverse = particles->m_inverse + first;
    double *restrict h = particles->h + first;
    double *restrict found = particles->h_inverse_found + first, *restrict V = particles->V + first,
                     *restrict rho = particles->rho + first, *restrict P = particles->P + first,
                     *restrict c = particles->c + first, *restrict g = particles->g + first;
    const double constant = gas->constant, eta_inverse = 1 / gas->eta, gamma_1 = gas->gamma - 1;
    const double follow = gas->follow * gamma_1;
    double surprised = 0;
#pragma omp simd reduction(+ : surprised)
    for (int i = 0; i < len; i++) {
        const double scale = constant * h_inverse[i], sum = scale * sums->m[i];
        const double u = U[i] * m_inverse[i];
        found[i] = sum * m_inverse[i] * eta_inverse;
        if (energy_sum) {
            const double y = scale * sums->Z[i];
            V[i] = U[i] / y;
            rho[i] = m[i] / V[i];
            P[i] = gamma_1 * y;
            h[i] = 1 / found[i];
        } else {
            V[i] = m[i] / sum;
            rho[i] = sum;
            h[i] = gas->eta * V[i];
            P[i] = gamma_1 * sum * u * largest(0.5, 1 + follow * (1 - h[i] * h_inverse[i]));
        }
        surprised += off_by(h[i] * h_inverse[i]) > surprise_max ? 1. : 0.;
        c[i] = sqrt(gas->gamma * gamma_1 * u);
        if (own_gradient) g[i] = scale * h_inverse[i];
    }
    return surprised;
}

/* 1/h as a Newton step from the width of the sums finds it, no further than a factor of 2 away:
 * close to the existence limit of h the step has no length. */
CLONES static void correct_width(const struct particles *particles, ptrdiff_t first, int len,
                                 const struct density_sums *restrict sums)
{
    const double *restrict h_inverse = particles->h_inverse + first;
    double *restrict found = particles->h_inverse_found + first;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double at = h_inverse[i] * sums->m[i];
        const double root =
            h_inverse[i] + (found[i] - h_inverse[i]) * at / (at - found[i] * sums->m_dh[i]);
        found[i] = largest(least(root, 2 * h_inverse[i]), 0.5 * h_inverse[i]);
    }
}

/* Nearly all ranges are full: a constant trip count has no remainder loop. */
#define BODY(function, energy_sum, own_gradient)                                                   \
    CLONES static double function(const struct particles *particles, ptrdiff_t first, int len,     \
                                  const struct gas *gas, const struct density_sums *sums)          \
    {                                                                                              \
        if (len == RANGE_MAX)                                                                      \
            return close_body(particles, first, RANGE_MAX, energy_sum, own_gradient, gas, sums);   \
        return close_body(particles, first, len, energy_sum, own_gradient, gas, sums);             \
    }
BODY(close_mass, false, false)
BODY(close_mass_gradient, false, true)
BODY(close_energy, true, false)
BODY(close_energy_gradient, true, true)

double range_close(const struct particles *particles, ptrdiff_t first, int len,
                   const struct plan *plan, const struct gas *gas, const struct density_sums *sums)
{
    const double surprised =
        plan->energy_sum ? (plan->own_gradient ? close_energy_gradient
                                               : close_energy)(particles, first, len, gas, sums)
                         : (plan->own_gradient ? close_mass_gradient : close_mass)(particles, first,
                                                                                   len, gas, sums);
    if (plan->correct) correct_width(particles, first, len, sums);
    if (!plan->grad_h) return surprised;
    double *restrict factor = particles->grad_h + first, *restrict b = particles->b + first;
    const double *restrict V = particles->V + first, *restrict P = particles->P + first,
                           *restrict Z = (plan->energy_sum ? particles->U : particles->m) + first;
    for (int i = 0; i < len; i++) {
        /* h/rho drho/dh = -m_dh/m, so f = 1/(1 - m_dh/m); with the energy element
         * f_ij = 1 - (m_j/Z_j) factor_i (Hopkins 2013), with the mass element f_i = 1 - factor_i */
        const double dh = plan->energy_sum ? sums->Z_dh[i] : sums->m_dh[i];
        factor[i] = -dh / (sums->m[i] - sums->m_dh[i]);
        b[i] = P[i] * (V[i] * V[i] / Z[i]);
    }
    return surprised;
}

bool range_surprised(const struct particles *particles, ptrdiff_t i)
{
    return off_by(particles->h[i] * particles->h_inverse[i]) > surprise_max;
}

CLONES static double rate(const struct particles *particles, ptrdiff_t first, int len)
{
    const double *restrict signal = particles->signal + first, *restrict h_inverse =
                                                                   particles->h_inverse + first;
    double of[RANGE_MAX];
#pragma omp simd
    for (int i = 0; i < RANGE_MAX; i++) of[i] = i < len ? signal[i] * h_inverse[i] : 0;
    /* by halves: clang does not vectorise reduction(max) */
    for (int half = RANGE_MAX / 2; half > 0; half /= 2)
        for (int i = 0; i < half; i++) of[i] = largest(of[i], of[i + half]);
    return of[0];
}

double range_primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
                        double kinetic)
{
    return primitives(particles, first, len, kinetic);
}

double range_crossings(const struct particles *particles, ptrdiff_t first, ptrdiff_t len)
{
    return crossings_in(particles, first, len);
}

double range_inside(const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t d)
{
    return inside_stamped(particles, first, len, d);
}

void range_predict_width(const struct particles *particles, ptrdiff_t first, int len, double ratio)
{
    predict_stamped(particles, first, len, ratio);
}

double range_rate(const struct particles *particles, ptrdiff_t first, int len)
{
    return rate(particles, first, len);
}
