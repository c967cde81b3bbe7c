/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces in 1D (CONVENTIONS section 5; pair.h). A half loop: for each offset d the fluxes of
 * the pairs (i, i+d) are stored in strips, then each particle collects its right and its left pair:
 * the order of summation is fixed, and momentum is conserved to round-off. Only loop_gradient.c
 * evaluates the kernel. With j right of i: r = x_j - x_i >= 0, G = grad_i W > 0. */
#include <math.h>
#include <string.h>

#include "loops.h"
#include "specialise.h"

/* Collects the pairs of each particle at offset d: the left one is strip[i], the right one strip[i
 * + d]. The first offset sets the sums, further offsets add to them. */
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

size_t loop_force_scratch(ptrdiff_t D)
{
    return FORCE_STRIPS * (size_t)(BATCH_MAX + D + 8); /* rounded up by a vector */
}

struct force_sums {
    double F[BATCH_MAX], de[BATCH_MAX], div_v[BATCH_MAX];
};

/* The values of particle k for a pair. */
ALWAYS_INLINE struct pair_side side_of(const struct particles *a, const double *Z, ptrdiff_t k)
{
    return (struct pair_side){.m = a->m[k],
                              .Z = Z[k],
                              .V = a->V[k],
                              .h_inverse = a->h_inverse[k],
                              .P = a->P[k],
                              .rho = a->rho[k],
                              .c = a->c[k],
                              .alpha = a->alpha[k],
                              .b = a->b[k],
                              .grad_h = a->grad_h[k],
                              .slope = a->dv[k]};
}

/* Adds the pairs at one offset. Returns their largest signal speed / h. */
ALWAYS_INLINE double pairs_at(ptrdiff_t d, enum formulation formulation, enum viscosity viscosity,
                              enum energy energy, const struct loops *loops,
                              const struct particles *particles, ptrdiff_t first, int len,
                              ptrdiff_t strip, double *scratch, struct force_sums *sums)
{
    double *restrict f = scratch, *restrict e_i = scratch + strip,
                     *restrict e_j = scratch + 2 * strip, *restrict s = scratch + 3 * strip,
                     *restrict G = scratch + 4 * strip, *restrict G_j = scratch + 5 * strip;
    const ptrdiff_t o = first - d;
    const int pairs = len + (int)d;
    loops->gradient(loops->kernel, particles, o, pairs, d, G, G_j);

    const double *restrict x = particles->x[0] + o, *restrict v = particles->v[0] + o,
                           *restrict h = particles->h + o, *restrict V = particles->V + o;
    const double *Z = loops->energy_element ? particles->U : particles->m;
    const struct pair_numbers numbers = loops->numbers;
    const int pair_count = whole_vectors(pairs);
#pragma omp simd
    for (int i = 0; i < pair_count; i++) {
        const struct pair_side left = side_of(particles, Z, o + i),
                               right = side_of(particles, Z, o + i + d);
        const double r = x[i + d] - x[i], closing = v[i] - v[i + d];
        struct pair_terms a = pair_pressure(formulation, &left, &right, G[i], G_j[i]);
        if (!viscosity_of[viscosity].none) {
            const double G_bar =
                formulation == FORMULATION_VANILLA_ICE ? G[i] : 0.5 * (G[i] + G_j[i]);
            const struct viscosity_pair pair = {r, closing, .factor = 1};
            const struct viscosity_terms terms =
                viscosity_terms_of(viscosity, &numbers, &left, &right, &pair);
            const struct pair_mean_width h_bar = pair_mean_width(h[i], h[i + d]);
            const double half = pair_viscous(terms, &left, &right, h_bar, r, G_bar);
            a.i += half;
            a.j += half;
        }
        f[i] = a.i + a.j;
        if (energy == ENERGY_TOTAL) {
            e_i[i] = pair_energy_flux(a, v[i], v[i + d]);
        } else {
            const struct pair_terms heating = pair_heating(a, closing);
            e_i[i] = heating.i;
            e_j[i] = heating.j;
        }
        /* for both particles: speed/h; for the left one also 2c/h */
        const double speed = pair_within(r, left.h_inverse, right.h_inverse)
                                 ? pair_signal_speed(left.c, right.c, closing)
                                 : 0;
        s[i] =
            largest(2 * left.c * left.h_inverse, speed * largest(left.h_inverse, right.h_inverse));
    }
    gather(d > 1, energy, whole_vectors(len), d, f, e_i, e_j, sums->F, sums->de);
    if (loops->div_v) {
        const double *both = formulation == FORMULATION_VANILLA_ICE ? G : G_j;
        for (int i = 0; i < pairs; i++) f[i] = 0.5 * (G[i] + both[i]) * (v[i] - v[i + d]);
        for (int i = 0; i < len; i++) sums->div_v[i] -= V[i + 2 * d] * f[i + d] + V[i] * f[i];
    }
    for (int i = pairs; i < pair_count; i++) s[i] = 0;
    return largest_of(s, pair_count);
}

ALWAYS_INLINE double force_body(enum formulation formulation, enum viscosity viscosity,
                                enum energy energy, const struct loops *loops,
                                const struct particles *particles, ptrdiff_t first, int len,
                                ptrdiff_t D, double *scratch)
{
    const ptrdiff_t strip = (ptrdiff_t)loop_force_scratch(D) / FORCE_STRIPS;
    struct force_sums sums;
    if (loops->div_v)
        for (int i = 0; i < len; i++) sums.div_v[i] = 0;
    /* most ranges need only the first offset, which so has constant addresses */
    double rate = pairs_at(1, formulation, viscosity, energy, loops, particles, first, len, strip,
                           scratch, &sums);
    for (ptrdiff_t d = 2; d <= D; d++)
        rate = largest(rate, pairs_at(d, formulation, viscosity, energy, loops, particles, first,
                                      len, strip, scratch, &sums));
    const size_t bytes = (size_t)len * sizeof(double);
    memcpy(particles->F[0] + first, sums.F, bytes);
    memcpy(particles->de + first, sums.de, bytes);
    if (loops->div_v) memcpy(particles->div_v + first, sums.div_v, bytes);
    return rate;
}

/* Expands X for every formulation, viscosity and energy. */
#define OVER_VISCOSITIES(f, name, label, paper, X)   VISCOSITY_LIST(OVER_ENERGIES, X, f)
#define OVER_ENERGIES(v, name, X, f)                 ENERGY_LIST(OVER_NOTHING, X, f, v)
#define OVER_NOTHING(e, name, label, paper, X, f, v) X(f, v, e)
#define ALL(X)                                       FORMULATION_LIST(OVER_VISCOSITIES, X)

#define BODY(function, formulation, viscosity, energy, attributes)                                 \
    attributes static double function(const struct loops *loops,                                   \
                                      const struct particles *particles, ptrdiff_t first, int len, \
                                      ptrdiff_t D, double *scratch)                                \
    {                                                                                              \
        if (viscosity_of[viscosity].least_dim > 1) return 0;                                       \
        return force_body(formulation, viscosity, energy, loops, particles, first, len, D,         \
                          scratch);                                                                \
    }
#define SPECIALISE(f, v, e) BODY(force_##f##_##v##_##e, f, v, e, CLONES)
ALL(SPECIALISE)

#define ENTRY(f, v, e) [f][v][e] = force_##f##_##v##_##e,
static force_loop *const specialised[FORMULATIONS][VISCOSITIES][ENERGIES] = {ALL(ENTRY)};

/* The generic loop: all choices at run time. */
static double generic(const struct loops *loops, const struct particles *particles, ptrdiff_t first,
                      int len, ptrdiff_t D, double *scratch)
{
    return force_body(loops->formulation, loops->viscosity, loops->energy, loops, particles, first,
                      len, D, scratch);
}

force_loop *loop_force(bool want_specialised, enum formulation formulation,
                       enum viscosity viscosity, enum energy energy)
{
    return want_specialised ? specialised[formulation][viscosity][energy] : generic;
}
