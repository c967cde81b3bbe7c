/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "state.h"

#include <math.h>

#include "stamp.h"

/* Stamped functions are static here, and the public ones call them: clang 14 gives the dispatched
 * symbol a name of its own, so that another file would not find it. */

ALWAYS_INLINE double primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
                                double kinetic, int dim)
{
    const double *restrict e = particles->e + first, *restrict m_inverse =
                                                         particles->m_inverse + first;
    double *restrict U = particles->U + first;
    const double *restrict p[3];
    double *restrict v[3];
    for (int k = 0; k < dim; k++) p[k] = particles->p[k] + first, v[k] = particles->v[k] + first;
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = 0; i < len; i++) {
        double internal = e[i];
        for (int k = 0; k < dim; k++) {
            const double v_k = p[k][i] * m_inverse[i];
            internal -= kinetic * p[k][i] * v_k;
            v[k][i] = v_k;
        }
        U[i] = internal;
        unsound += internal > 0 ? 0. : 1.;
    }
    return unsound;
}

#define BODY(dim)                                                                                  \
    CLONES static double primitives_##dim(const struct particles *particles, ptrdiff_t first,      \
                                          ptrdiff_t len, double kinetic)                           \
    {                                                                                              \
        return primitives(particles, first, len, kinetic, dim);                                    \
    }
BODY(1)
BODY(2)
BODY(3)
#undef BODY

double state_primitives(const struct particles *particles, ptrdiff_t first, ptrdiff_t len,
                        double kinetic)
{
    return (particles->dim == 1   ? primitives_1
            : particles->dim == 2 ? primitives_2
                                  : primitives_3)(particles, first, len, kinetic);
}

/* x^d and x^(1/d). */
ALWAYS_INLINE double power(double x, int dim)
{
    return dim == 1 ? x : dim == 2 ? x * x : x * x * x;
}

ALWAYS_INLINE double root(double x, int dim)
{
    return dim == 1 ? x : dim == 2 ? sqrt(x) : cbrt(x);
}

ALWAYS_INLINE double off_by(double ratio)
{
    return largest(ratio - 1, 1 - ratio);
}

/* A predicted width may be off by this part. */
static const double surprise_max = 0.3;

ALWAYS_INLINE double close_body(const struct particles *particles, ptrdiff_t first, int len,
                                bool energy_sum, bool own_gradient, int dim, const struct gas *gas,
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
        const double scale = constant * power(h_inverse[i], dim), sum = scale * sums->m[i];
        const double u = U[i] * m_inverse[i];
        found[i] = root(sum * m_inverse[i], dim) * eta_inverse;
        if (energy_sum) {
            const double y = scale * sums->Z[i];
            V[i] = U[i] / y;
            rho[i] = m[i] / V[i];
            P[i] = gamma_1 * y;
            h[i] = 1 / found[i];
        } else {
            V[i] = m[i] / sum;
            rho[i] = sum;
            h[i] = gas->eta * root(V[i], dim);
            P[i] = gamma_1 * sum * u *
                   largest(0.5, 1 + follow * (1 - power(h[i] * h_inverse[i], dim)));
        }
        surprised += off_by(h[i] * h_inverse[i]) > surprise_max ? 1. : 0.;
        c[i] = sqrt(gas->gamma * gamma_1 * u);
        if (own_gradient) g[i] = scale * h_inverse[i];
    }
    return surprised;
}

/* 1/h as a step of CONVENTIONS eq. 3.10 from the width of the sums finds it, no further than a
 * factor of 2 away: close to the existence limit of h the step has no length. */
CLONES static void correct_width(const struct particles *particles, ptrdiff_t first, int len,
                                 const struct density_sums *restrict sums)
{
    const double *restrict h_inverse = particles->h_inverse + first;
    double *restrict found = particles->h_inverse_found + first;
    const double d = particles->dim;
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double at = d * (h_inverse[i] * sums->m[i]);
        const double root =
            h_inverse[i] + (found[i] - h_inverse[i]) * at / (at - found[i] * sums->m_dh[i]);
        found[i] = largest(least(root, 2 * h_inverse[i]), 0.5 * h_inverse[i]);
    }
}

/* Nearly all batches are full: a constant trip count has no remainder loop. */
#define BODY(energy_sum, own_gradient, dim)                                                        \
    CLONES static double close_##energy_sum##_##own_gradient##_##dim(                              \
        const struct particles *particles, ptrdiff_t first, int len, const struct gas *gas,        \
        const struct density_sums *sums)                                                           \
    {                                                                                              \
        if (len == BATCH_MAX)                                                                      \
            return close_body(particles, first, BATCH_MAX, energy_sum, own_gradient, dim, gas,     \
                              sums);                                                               \
        return close_body(particles, first, len, energy_sum, own_gradient, dim, gas, sums);        \
    }
#define DIMENSIONS(X, energy_sum, own_gradient)                                                    \
    X(energy_sum, own_gradient, 1) X(energy_sum, own_gradient, 2) X(energy_sum, own_gradient, 3)
#define ALL(X) DIMENSIONS(X, 0, 0) DIMENSIONS(X, 0, 1) DIMENSIONS(X, 1, 0) DIMENSIONS(X, 1, 1)
ALL(BODY)
#undef BODY

typedef double close_loop(const struct particles *particles, ptrdiff_t first, int len,
                          const struct gas *gas, const struct density_sums *sums);
#define ENTRY(energy_sum, own_gradient, dim)                                                       \
    [energy_sum][own_gradient][dim - 1] = close_##energy_sum##_##own_gradient##_##dim,
static close_loop *const close_loops[2][2][3] = {ALL(ENTRY)};

/* The factors of the grad-h terms (CONVENTIONS eqs. 3.7 to 3.9). With the energy element f_ij = 1 -
 * (m_j/Z_j) grad_h_i (Hopkins 2013), with the mass element f_i = 1 - grad_h_i; (h/(d rho)) drho/dh
 * = -m_dh/(d m). */
static void find_grad_h(const struct particles *particles, ptrdiff_t first, int len,
                        bool energy_sum, const struct density_sums *restrict sums)
{
    double *restrict factor = particles->grad_h + first, *restrict b = particles->b + first;
    const double *restrict V = particles->V + first, *restrict P = particles->P + first,
                           *restrict Z = (energy_sum ? particles->U : particles->m) + first;
    const double d = particles->dim;
    for (int i = 0; i < len; i++) {
        const double dh = energy_sum ? sums->Z_dh[i] : sums->m_dh[i];
        factor[i] = -dh / (d * sums->m[i] - sums->m_dh[i]);
        b[i] = P[i] * (V[i] * V[i] / Z[i]);
    }
}

double state_close(const struct particles *particles, ptrdiff_t first, int len,
                   const struct plan *plan, const struct gas *gas, const struct density_sums *sums)
{
    const double surprised = close_loops[plan->energy_sum][plan->own_gradient][particles->dim - 1](
        particles, first, len, gas, sums);
    if (plan->correct) correct_width(particles, first, len, sums);
    if (plan->grad_h) find_grad_h(particles, first, len, plan->energy_sum, sums);
    return surprised;
}

bool state_surprised(const struct particles *particles, ptrdiff_t i)
{
    return off_by(particles->h[i] * particles->h_inverse[i]) > surprise_max;
}

void state_dalpha(const struct particles *particles, ptrdiff_t first, int len,
                  const struct scheme *scheme)
{
    const struct particles *a = particles;
    for (ptrdiff_t i = first; i < first + len; i++) {
        const double growth =
            largest(-a->div_v[i], 0) * largest(scheme->alpha_max - a->alpha[i], 0);
        a->dalpha[i] = growth - (a->alpha[i] - scheme->alpha_min) * 0.2 * a->c[i] / a->h[i];
    }
}

CLONES static double rate(const struct particles *particles, ptrdiff_t first, int len)
{
    const double *restrict signal = particles->signal + first, *restrict h_inverse =
                                                                   particles->h_inverse + first;
    double of[BATCH_MAX];
#pragma omp simd
    for (int i = 0; i < BATCH_MAX; i++) of[i] = i < len ? signal[i] * h_inverse[i] : 0;
    /* by halves: clang does not vectorise reduction(max) */
    for (int half = BATCH_MAX / 2; half > 0; half /= 2)
        for (int i = 0; i < half; i++) of[i] = largest(of[i], of[i + half]);
    return of[0];
}

double state_rate(const struct particles *particles, ptrdiff_t first, int len)
{
    return rate(particles, first, len);
}
