/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "state.h"

#include <math.h>

#include "cube_root.h"
#include "specialise.h"
#include "viscosity.h"

/* CLONES functions are static, and public functions call them: clang 14 renames the dispatched
 * symbol, so that other files would not find it. */

ALWAYS_INLINE double primitives(const struct particles *particles, double kinetic, int dim)
{
    const double *restrict e = particles->e, *restrict m_inverse = particles->m_inverse;
    double *restrict U = particles->U;
    const double *restrict p[3];
    double *restrict v[3];
    for (int k = 0; k < dim; k++) p[k] = particles->p[k], v[k] = particles->v[k];
    double unsound = 0;
#pragma omp simd reduction(+ : unsound)
    for (ptrdiff_t i = 0; i < particles->n; i++) {
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
    CLONES static double primitives_##dim(const struct particles *particles, double kinetic)       \
    {                                                                                              \
        return primitives(particles, kinetic, dim);                                                \
    }
BODY(1)
BODY(2)
BODY(3)
#undef BODY

double state_primitives(const struct particles *particles, double kinetic)
{
    return (particles->dim == 1   ? primitives_1
            : particles->dim == 2 ? primitives_2
                                  : primitives_3)(particles, kinetic);
}

/* x^d and x^(1/d). */
ALWAYS_INLINE double power(double x, int dim)
{
    return dim == 1 ? x : dim == 2 ? x * x : x * x * x;
}

ALWAYS_INLINE double root(double x, int dim)
{
    return dim == 1 ? x : dim == 2 ? sqrt(x) : cube_root(x);
}

/* Lower bound of the slope of eq. 3.10: near the existence limit of h Newton's step diverges. */
static const double least_slope = 0.25;

ALWAYS_INLINE void close_body(const struct particles *particles, ptrdiff_t first, int len,
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
#pragma omp simd
    for (int i = 0; i < len; i++) {
        const double s = h_inverse[i], scale = constant * power(s, dim), sum = scale * sums->m[i];
        const double u = U[i] * m_inverse[i], asked = root(sum * m_inverse[i], dim) * eta_inverse;
        /* 1/h by one step of CONVENTIONS eq. 3.10, changed by at most a factor of 2. The same
         * division gives the volume: share = 1/(slope sum). */
        const double at = dim * (s * sums->m[i]);
        const double slope = largest(at - asked * sums->m_dh[i], least_slope * at);
        const double share = 1 / (slope * sum);
        found[i] = largest(0.5 * s, least(2 * s, s + (asked - s) * (at * (sum * share))));
        if (energy_sum) {
            const double y = scale * sums->Z[i];
            V[i] = U[i] / y;
            rho[i] = m[i] / V[i];
            P[i] = gamma_1 * y;
            h[i] = 1 / asked;
        } else {
            V[i] = m[i] * (slope * share);
            rho[i] = sum;
            h[i] = dim == 1 ? gas->eta * V[i] : 1 / asked; /* equal to 1/asked */
            P[i] = gamma_1 * sum * u * largest(0.5, 1 + follow * (1 - power(h[i] * s, dim)));
        }
        c[i] = sqrt(gas->gamma * gamma_1 * u);
        if (own_gradient) g[i] = scale * s;
    }
}

/* Nearly all batches are full, and a constant trip count needs no remainder loop. */
#define BODY(energy_sum, own_gradient, dim)                                                        \
    CLONES static void close_##energy_sum##_##own_gradient##_##dim(                                \
        const struct particles *particles, ptrdiff_t first, int len, const struct gas *gas,        \
        const struct density_sums *sums)                                                           \
    {                                                                                              \
        if (len == BATCH_MAX)                                                                      \
            close_body(particles, first, BATCH_MAX, energy_sum, own_gradient, dim, gas, sums);     \
        else                                                                                       \
            close_body(particles, first, len, energy_sum, own_gradient, dim, gas, sums);           \
    }
#define DIMENSIONS(X, energy_sum, own_gradient)                                                    \
    X(energy_sum, own_gradient, 1) X(energy_sum, own_gradient, 2) X(energy_sum, own_gradient, 3)
#define ALL(X) DIMENSIONS(X, 0, 0) DIMENSIONS(X, 0, 1) DIMENSIONS(X, 1, 0) DIMENSIONS(X, 1, 1)
ALL(BODY)
#undef BODY

typedef void close_loop(const struct particles *particles, ptrdiff_t first, int len,
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

void state_close(const struct particles *particles, ptrdiff_t first, int len,
                 const struct plan *plan, const struct gas *gas, const struct density_sums *sums)
{
    close_loops[plan->energy_sum][plan->own_gradient][particles->dim - 1](particles, first, len,
                                                                          gas, sums);
    if (plan->grad_h) find_grad_h(particles, first, len, plan->energy_sum, sums);
}

void state_dalpha(const struct particles *particles, ptrdiff_t first, int len,
                  const struct scheme *scheme)
{
    viscosity_of[scheme->viscosity].evolve(particles, first, len, scheme->alpha_min,
                                           scheme->alpha_max);
}

CLONES static double rate(const struct particles *particles, ptrdiff_t first, int len)
{
    const double *restrict signal = particles->signal + first, *restrict h_inverse =
                                                                   particles->h_inverse + first;
    double of[BATCH_MAX];
#pragma omp simd
    for (int i = 0; i < BATCH_MAX; i++) of[i] = i < len ? signal[i] * h_inverse[i] : 0;
    return largest_of(of, BATCH_MAX);
}

double state_rate(const struct particles *particles, ptrdiff_t first, int len)
{
    return rate(particles, first, len);
}
