/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces in 1D (PHYSICS: equations of motion). A half loop: for each offset d the fluxes of
 * the pairs (i, i+d) go into strips, then every particle collects its right and its left pair:
 * the order of summation is fixed, and momentum is conserved to round-off. The kernel stands in
 * loop_gradient.c alone. With j right of i: r = x_j - x_i >= 0, G = grad_i W > 0. */
#include <math.h>
#include <string.h>

#include "loop.h"

/* exp(-z) for 0 <= z <= 7, to 8e-7 relative: (exp(-z/16))^16 by the series, in pairs of terms: what
 * counts is the length of the chain. Vectorises. */
ALWAYS_INLINE double damping(double z)
{
    const double t = -0.0625 * z, t2 = t * t;
    const double low = (1 + t) + t2 * (1. / 2 + t * (1. / 6));
    const double high = (1. / 24 + t * (1. / 120)) + t2 * (1. / 720 + t * (1. / 5040));
    double s = low + t2 * t2 * high;
    s *= s;
    s *= s;
    s *= s;
    return s * s;
}

/* Closing speed of a pair extrapolated to its midpoint with a limited slope (Rosswog 2020, MAGMA2
 * eqs. 18-22): v_ij + phi/2 (v'_i + v'_j) r, phi = max(0, 4 v'_i v'_j/(v'_i + v'_j)^2) damped in
 * pairs closer than q = near. As a fraction over *scale, so that the pair needs one division. Zero
 * where the pair itself recedes: the heating uses v_ij, and viscosity never cools. */
ALWAYS_INLINE double closing_at_midpoint(double v_ij, double slope_i, double slope_j, double r,
                                         double q, double near, double *scale)
{
    const double sum = slope_i + slope_j, product = slope_i * slope_j;
    const double z = q < near ? least((near - q) * 5, 2.6) : 0;
    const double one_sided = product > 0 ? 2 * r * product * damping(z * z) : 0;
    *scale = product > 0 ? sum : 1;
    const double closing = v_ij * *scale + one_sided;
    return v_ij > 0 && closing * *scale > 0 ? closing : 0;
}

/* Viscosity fading: the linear term sees the speed of sound only where a pair closes faster than
 * this part of it, and a proportionally smaller one below: smooth flow is left alone, to second
 * order, while shocks (0.1 c and more a pair) do not notice. */
static const double fade_below = 0.01;

/* What a particle gathers at offset d: its pair to the left is strip[i], to the right strip[i + d].
 * The first offset sets the sums, the others add to them. */
ALWAYS_INLINE void gather(bool add, enum energy energy, int count, ptrdiff_t d,
                          const double *restrict f, const double *restrict e_i,
                          const double *restrict e_j, double *restrict F, double *restrict de)
{
#pragma omp simd
    for (int i = 0; i < count; i++) {
        const double force = f[i] - f[i + d];
        const double power = energy == ENERGY_TOTAL ? e_i[i] - e_i[i + d] : e_i[i + d] + e_j[i];
        F[i] = add ? F[i] + force : force;
        de[i] = add ? de[i] + power : power;
    }
}

size_t force_scratch(ptrdiff_t D)
{
    return STRIPS * (size_t)(RANGE_MAX + D + 8); /* and the rest of a vector */
}

struct sums {
    double F[RANGE_MAX], de[RANGE_MAX], div_v[RANGE_MAX];
};

/* The pairs at one offset. Returns their largest speed / h. */
ALWAYS_INLINE double pairs_at(ptrdiff_t d, enum formulation formulation,
                              enum pair_viscosity viscosity, enum energy energy,
                              const struct loops *loops, const struct pair_numbers *numbers,
                              const struct particles *particles, ptrdiff_t first, int len,
                              ptrdiff_t strip, double *scratch, struct sums *sums)
{
    const double alpha_0 = numbers->alpha, beta_0 = numbers->beta, beta_ratio = numbers->beta_ratio,
                 near = numbers->near;
    double *restrict f = scratch, *restrict e_i = scratch + strip,
                     *restrict e_j = scratch + 2 * strip, *restrict s = scratch + 3 * strip,
                     *restrict G = scratch + 4 * strip, *restrict G_j = scratch + 5 * strip;
    const ptrdiff_t o = first - d;
    const int pairs = len + (int)d;
    loops->gradient(numbers->kernel, particles, o, pairs, d, G, G_j);

    const double *restrict x = particles->x + o, *restrict v = particles->v + o,
                           *restrict m = particles->m + o, *restrict h = particles->h + o,
                           *restrict P = particles->P + o, *restrict c = particles->c + o,
                           *restrict rho = particles->rho + o,
                           *restrict alpha = particles->alpha + o, *restrict V = particles->V + o,
                           *restrict b = particles->b + o, *restrict grad_h = particles->grad_h + o,
                           *restrict dv = particles->dv + o,
                           *restrict h_inverse = particles->h_inverse + o;
    const double *restrict Z = (numbers->energy_element ? particles->U : particles->m) + o;
    const int pair_count = whole_vectors(pairs);
#pragma omp simd
    for (int i = 0; i < pair_count; i++) {
        const ptrdiff_t j = i + d;
        const double r = x[j] - x[i], v_ij = v[i] - v[j], c_sum = c[i] + c[j];
        double a_i, a_j; /* pressure */
        if (formulation == FORMULATION_VANILLA_ICE) {
            const double A = V[i] * V[j] * G[i];
            a_i = A * P[i];
            a_j = A * P[j];
        } else {
            a_i = b[i] * (Z[j] - m[j] * grad_h[i]) * G[i];
            a_j = b[j] * (Z[i] - m[i] * grad_h[j]) * G_j[i];
        }
        if (viscosity != PAIR_INVISCID) {
            double scale = 1;
            const double closing =
                viscosity == PAIR_RECONSTRUCTED
                    ? closing_at_midpoint(v_ij, dv[i], dv[j], r,
                                          r * least(h_inverse[i], h_inverse[j]), near, &scale)
                    : largest(v_ij, 0);
            const double G_bar =
                formulation == FORMULATION_VANILLA_ICE ? G[i] : 0.5 * (G[i] + G_j[i]);
            /* mu = -t/(D2 scale), PI = (-alpha c mu + beta mu^2)/rho; c and rho are sums of
             * two, K = m_i m_j PI G is shared between the two */
            const double h_bar = 0.25 * (h[i] + h[j]);
            const double t = h_bar * r * closing, D2 = (r * r + 0.01 * (h_bar * h_bar)) * scale;
            const bool varying = viscosity == PAIR_VARYING;
            const double alpha_half = varying ? 0.25 * (alpha[i] + alpha[j]) : 0.5 * alpha_0;
            const double beta_bar = varying ? 2 * beta_ratio * alpha_half : beta_0;
            const double c_seen =
                viscosity == PAIR_FADING ? least(c_sum, closing * (2 / fade_below)) : c_sum;
            const double half_K = m[i] * m[j] * G_bar * t *
                                  (alpha_half * c_seen * D2 + beta_bar * t) /
                                  (D2 * D2 * (rho[i] + rho[j]));
            a_i += half_K;
            a_j += half_K;
        }
        f[i] = a_i + a_j;
        if (energy == ENERGY_TOTAL) {
            e_i[i] = a_j * v[i] + a_i * v[j];
        } else {
            e_i[i] = a_i * v_ij;
            e_j[i] = a_j * v_ij;
        }
        /* of both particles: speed/h, and 2c/h of the left one alone */
        const double speed = r < largest(h[i], h[j]) ? c_sum + 3 * largest(v_ij, 0) : 0;
        s[i] = largest(2 * c[i] * h_inverse[i], speed * largest(h_inverse[i], h_inverse[j]));
    }
    gather(d > 1, energy, whole_vectors(len), d, f, e_i, e_j, sums->F, sums->de);
    if (numbers->want_div_v) {
        const double *both = formulation == FORMULATION_VANILLA_ICE ? G : G_j;
        for (int i = 0; i < pairs; i++) f[i] = 0.5 * (G[i] + both[i]) * (v[i] - v[i + d]);
        for (int i = 0; i < len; i++) sums->div_v[i] -= V[i + 2 * d] * f[i + d] + V[i] * f[i];
    }
    for (int i = pairs; i < pair_count; i++) s[i] = 0;
    return largest_of(s, pair_count);
}

ALWAYS_INLINE double force_body(enum formulation formulation, enum pair_viscosity viscosity,
                                enum energy energy, const struct loops *loops,
                                const struct pair_numbers *numbers,
                                const struct particles *particles, ptrdiff_t first, int len,
                                ptrdiff_t D, double *scratch)
{
    const ptrdiff_t strip = (ptrdiff_t)force_scratch(D) / STRIPS;
    struct sums sums;
    if (numbers->want_div_v)
        for (int i = 0; i < len; i++) sums.div_v[i] = 0;
    /* most ranges need no more than the first offset: it stands with constant addresses */
    double rate = pairs_at(1, formulation, viscosity, energy, loops, numbers, particles, first, len,
                           strip, scratch, &sums);
    for (ptrdiff_t d = 2; d <= D; d++)
        rate = largest(rate, pairs_at(d, formulation, viscosity, energy, loops, numbers, particles,
                                      first, len, strip, scratch, &sums));
    const size_t bytes = (size_t)len * sizeof(double);
    memcpy(particles->F + first, sums.F, bytes);
    memcpy(particles->de + first, sums.de, bytes);
    if (numbers->want_div_v) memcpy(particles->div_v + first, sums.div_v, bytes);
    return rate;
}

#define ENERGIES(X, f, v) X(f, v, ENERGY_INTERNAL) X(f, v, ENERGY_TOTAL)
#define VISCOSITIES(X, f)                                                                          \
    ENERGIES(X, f, PAIR_INVISCID)                                                                  \
    ENERGIES(X, f, PAIR_UNIFORM)                                                                   \
    ENERGIES(X, f, PAIR_VARYING) ENERGIES(X, f, PAIR_RECONSTRUCTED) ENERGIES(X, f, PAIR_FADING)
#define ALL(X) VISCOSITIES(X, FORMULATION_VANILLA_ICE) VISCOSITIES(X, FORMULATION_LAGRANGIAN)

#define BODY(function, formulation, viscosity, energy, attributes)                                 \
    attributes static double function(                                                             \
        const struct loops *loops, const struct pair_numbers *numbers,                             \
        const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t D, double *scratch) \
    {                                                                                              \
        return force_body(formulation, viscosity, energy, loops, numbers, particles, first, len,   \
                          D, scratch);                                                             \
    }
#define STAMP(f, v, e) BODY(force_##f##_##v##_##e, f, v, e, CLONES)
ALL(STAMP)

#define ENTRY(f, v, e) [f][v][e] = force_##f##_##v##_##e,
static force_loop *const stamped[2][PAIR_VISCOSITIES][2] = {ALL(ENTRY)};

/* The unstamped body: every choice is looked up at run time. */
static double unstamped(const struct loops *loops, const struct pair_numbers *numbers,
                        const struct particles *particles, ptrdiff_t first, int len, ptrdiff_t D,
                        double *scratch)
{
    return force_body(numbers->formulation, numbers->viscosity, numbers->energy, loops, numbers,
                      particles, first, len, D, scratch);
}

force_loop *loop_force(bool want_stamped, enum formulation formulation,
                       enum pair_viscosity viscosity, enum energy energy)
{
    return want_stamped ? stamped[formulation][viscosity][energy] : unstamped;
}
