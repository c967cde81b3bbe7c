/* SPDX-License-Identifier: GPL-3.0-or-later
 * Dissipation in 2D and 3D: artificial viscosity and conductivity of the pairs of one particle.
 * Closing speeds, slopes and gradients have been computed before. */
#include <math.h>

#include "pairs.h"
#include "specialise.h"

/* Inputs of find_slopes, for the particle (own) and its neighbours; P is NULL without noise. */
struct slopes {
    const double *x, *own_L, *L, *own_P, *P, *own_v, *v;
    ptrdiff_t stride;
};

struct slope_terms {
    double own, others, noise;
};

/* Contribution of one axis for the neighbour in lane k. The caller writes out the axes: nested
 * loops would not be vectorised. */
ALWAYS_INLINE struct slope_terms slope_along(int dim, bool projected, int a, ptrdiff_t k,
                                             const struct slopes *s)
{
    const double *restrict x = s->x, *restrict L = s->L, *restrict P = s->P, *restrict v = s->v;
    const ptrdiff_t stride = s->stride;
    const double xa = x[a * stride + k];
    double u = 0, u_j = 0, e = 0;
    for (int b = 0; b < dim; b++) {
        const double xb = x[b * stride + k];
        const int ab = symmetric_at(dim, a, b);
        u += s->own_L[a * dim + b] * xb;
        u_j += L[(a * dim + b) * stride + k] * xb;
        if (projected) e += (s->own_P[ab] + P[ab * stride + k]) * xb;
    }
    const double moving = projected ? (s->own_v[a] - v[a * stride + k]) + 0.5 * (u + u_j) : 0;
    return (struct slope_terms){xa * u, xa * u_j, (xa - 0.5 * e) * moving};
}

/* x . L x/r^2 with L of the particle and of each neighbour, and, if projected, the closing speed of
 * noise, x/r . (1 - P_ij) (v_ij + (L_i + L_j) x/2). */
ALWAYS_INLINE void slopes_body(int dim, bool projected, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const struct slopes slopes = {
        .x = lane(lanes, LANE_DX),
        .own_L = pairs_own(pairs, RECORD_SLOPE),
        .L = pairs_others(pairs, RECORD_SLOPE),
        .own_P = projected ? pairs_own(pairs, RECORD_PROJECTOR) : NULL,
        .P = projected ? pairs_others(pairs, RECORD_PROJECTOR) : NULL,
        .own_v = pairs_own(pairs, RECORD_VELOCITY),
        .v = pairs_others(pairs, RECORD_VELOCITY),
        .stride = lanes->stride,
    };
    const double *restrict r_inverse = lane(lanes, LANE_R_INVERSE);
    double *restrict slope_i = lane(lanes, LANE_SLOPE_I),
                     *restrict slope_j = lane(lanes, LANE_SLOPE_J),
                     *restrict noise = lane(lanes, LANE_SPARE);
    const int count = pairs->count;
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        const struct slope_terms x = slope_along(dim, projected, 0, k, &slopes),
                                 y = slope_along(dim, projected, 1, k, &slopes);
        struct slope_terms sum = {x.own + y.own, x.others + y.others, x.noise + y.noise};
        if (dim == 3) {
            const struct slope_terms z = slope_along(dim, projected, 2, k, &slopes);
            sum.own += z.own, sum.others += z.others, sum.noise += z.noise;
        }
        const double per_r2 = r_inverse[k] * r_inverse[k];
        slope_i[k] = sum.own * per_r2;
        slope_j[k] = sum.others * per_r2;
        if (projected) noise[k] = sum.noise * r_inverse[k];
    }
}

CLONES static void find_slopes(int dim, bool projected, const struct pairs *pairs)
{
    if (dim == 2 && projected)
        slopes_body(2, true, pairs);
    else if (dim == 2)
        slopes_body(2, false, pairs);
    else if (projected)
        slopes_body(3, true, pairs);
    else
        slopes_body(3, false, pairs);
}

/* -v_ij . G of the neighbour in lane k; viscosity heats where this is positive. */
ALWAYS_INLINE double approach(int dim, ptrdiff_t stride, ptrdiff_t k, const double *own_v,
                              const double *restrict v, const double *restrict G)
{
    double sum = (v[k] - own_v[0]) * G[k];
    for (int a = 1; a < dim; a++) sum += (v[a * stride + k] - own_v[a]) * G[a * stride + k];
    return sum;
}

/* K, the viscous term added to both a_i and a_j, for G = 1. With slopes, viscosity that would cool
 * is set to 0: with a matrix a pair may approach against its gradient. */
ALWAYS_INLINE void viscous_body(enum viscosity viscosity, bool signal_form, int dim,
                                const struct cells_method *method, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const struct pair_numbers numbers = method->numbers;
    const bool varying = viscosity_varies(viscosity), noisy = viscosity_of[viscosity].noise,
               sloped = viscosity_of[viscosity].midpoint;
    const double *restrict m = pairs_others(pairs, RECORD_WEIGHT),
                           *restrict h_inverse = pairs_others(pairs, RECORD_H_INVERSE),
                           *restrict c = pairs_others(pairs, RECORD_SOUND),
                           *restrict rho = pairs_others(pairs, RECORD_DENSITY),
                           *restrict alpha = varying ? pairs_others(pairs, RECORD_ALPHA) : NULL,
                           *restrict v = pairs_others(pairs, RECORD_VELOCITY),
                           *restrict factor = method->balsara ? pairs_others(pairs, RECORD_BALSARA)
                                                              : lane(lanes, LANE_ONE);
    const double
        *restrict slope_i = lane(lanes, LANE_SLOPE_I),
                  *restrict slope_j = lane(lanes, LANE_SLOPE_J), *restrict r = lane(lanes, LANE_R),
                  *restrict closing = lane(lanes, LANE_CLOSING),
                  *restrict noise = lane(lanes, LANE_SPARE), *restrict G = lane(lanes, LANE_GX);
    const double *own_v = pairs_own(pairs, RECORD_VELOCITY);
    const double own_m = *pairs_own(pairs, RECORD_WEIGHT),
                 own_h_inverse = *pairs_own(pairs, RECORD_H_INVERSE),
                 own_c = *pairs_own(pairs, RECORD_SOUND),
                 own_rho = *pairs_own(pairs, RECORD_DENSITY),
                 own_alpha = varying ? *pairs_own(pairs, RECORD_ALPHA) : 0,
                 own_factor = method->balsara ? *pairs_own(pairs, RECORD_BALSARA) : 1;
    double *restrict K = lane(lanes, LANE_K);
#pragma omp simd
    for (int k = 0; k < whole_vectors(pairs->count); k++) {
        const struct pair_side i = {.m = own_m,
                                    .h_inverse = own_h_inverse,
                                    .c = own_c,
                                    .rho = own_rho,
                                    .alpha = own_alpha,
                                    .slope = sloped ? slope_i[k] : 0};
        const struct pair_side j = {.m = m[k],
                                    .h_inverse = h_inverse[k],
                                    .c = c[k],
                                    .rho = rho[k],
                                    .alpha = varying ? alpha[k] : 0,
                                    .slope = sloped ? slope_j[k] : 0};
        const struct viscosity_pair pair = {.r = r[k],
                                            .closing = closing[k],
                                            .factor = 0.5 * (own_factor + factor[k]),
                                            .noise = noisy ? noise[k] : 0};
        const struct viscosity_terms terms = viscosity_terms_of(viscosity, &numbers, &i, &j, &pair);
        const struct pair_mean_width h_bar = pair_mean_width_inverse(own_h_inverse, h_inverse[k]);
        double term = signal_form ? pair_viscous_signal(sloped, terms, &i, &j, 1)
                                  : pair_viscous(terms, &i, &j, h_bar, r[k], 1);
        term *= terms.factor;
        if (sloped) term = approach(dim, lanes->stride, k, own_v, v, G) > 0 ? term : 0;
        if (noisy) term += terms.extra;
        K[k] = term;
    }
}

#define VISCOUS_CASE(symbol, name, signal_form, dim)                                               \
    case symbol:                                                                                   \
        if (signal_form || !viscosity_of[symbol].noise)                                            \
            viscous_body(symbol, signal_form, dim, method, pairs);                                 \
        break;

#define VISCOUS(name, signal_form, dim)                                                            \
    CLONES static void name(enum viscosity viscosity, const struct cells_method *method,           \
                            const struct pairs *pairs)                                             \
    {                                                                                              \
        switch (viscosity) {                                                                       \
            VISCOSITY_LIST(VISCOUS_CASE, signal_form, dim)                                         \
        }                                                                                          \
    }
VISCOUS(viscous_mu_2, false, 2)
VISCOUS(viscous_mu_3, false, 3)
VISCOUS(viscous_signal_2, true, 2)
VISCOUS(viscous_signal_3, true, 3)

/* True if no pair has a relative velocity and no particle has a velocity gradient, so that
 * viscosity vanishes. */
static bool all_still(const struct cells_method *method, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const int dim = method->box.dim, count = pairs->neighbours;
    const double *own_v = pairs_own(pairs, RECORD_VELOCITY),
                 *v = pairs_others(pairs, RECORD_VELOCITY),
                 limit = method->still * *pairs_own(pairs, RECORD_SOUND);
    static const double none[CELLS_SQUARE];
    /* in moving gas the first neighbour usually settles it */
    if (!(count > 0 && fabs(*v - *own_v) < limit) || viscosity_of[method->viscosity].none)
        return false;
    if (viscosity_of[method->viscosity].midpoint) {
        const double *own_L = pairs_own(pairs, RECORD_SLOPE),
                     rate = limit * *pairs_own(pairs, RECORD_H_INVERSE);
        for (int k = 0; k < dim * dim; k++)
            if (!(fabs(own_L[k]) <= rate)) return false;
        if (!lanes_agree(dim * dim, count, lanes->stride, none, pairs_others(pairs, RECORD_SLOPE),
                         rate))
            return false;
    }
    return lanes_agree(dim, count, lanes->stride, own_v, v, limit);
}

bool cells_viscosity(const struct cells *cells, const struct pairs *pairs)
{
    const struct cells_method *method = &cells->method;
    const int dim = method->box.dim;
    const bool still = all_still(method, pairs);
    if (viscosity_of[method->viscosity].none || still) {
        double *K = lane(pairs->lanes, LANE_K);
        for (int k = 0; k < pairs->count; k++) K[k] = 0;
        return !still;
    }
    const enum viscosity viscosity = method->viscosity;
    const bool noisy = viscosity_of[viscosity].noise;
    if (viscosity_of[viscosity].midpoint || noisy) find_slopes(dim, noisy, pairs);
    if (method->signal_form)
        (dim == 2 ? viscous_signal_2 : viscous_signal_3)(viscosity, method, pairs);
    else
        (dim == 2 ? viscous_mu_2 : viscous_mu_3)(viscosity, method, pairs);
    return true;
}

/* Heat by conductivity (CONVENTIONS eq. 6.8); the neighbours lose what the particle gains. */
CLONES static double conducted(int dim, double alpha_u, double alpha_s, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const ptrdiff_t stride = lanes->stride;
    const int count = pairs->count;
    const double *x = lane(lanes, LANE_DX),
                 *G = lane(lanes, LANE_GX), *restrict r_inverse = lane(lanes, LANE_R_INVERSE);
    const double *restrict m = pairs_others(pairs, RECORD_WEIGHT),
                           *restrict rho = pairs_others(pairs, RECORD_DENSITY),
                           *restrict P = pairs_others(pairs, RECORD_PRESSURE),
                           *restrict u = pairs_others(pairs, RECORD_HEAT);
    const double own_m = *pairs_own(pairs, RECORD_WEIGHT),
                 own_P = *pairs_own(pairs, RECORD_PRESSURE),
                 own_rho = *pairs_own(pairs, RECORD_DENSITY),
                 own_u = *pairs_own(pairs, RECORD_HEAT);
    /* K is free: forces have been added. The reactions have not been applied yet. */
    double *restrict s = lane(lanes, LANE_K);
    double *restrict reaction = lane(lanes, LANE_REACTION + dim);
    for (int k = 0; k < count; k++) s[k] = 0;
    for (int a = 0; a < dim; a++) {
        const double *restrict xa = x + a * stride, *restrict Ga = G + a * stride;
#pragma omp simd
        for (int k = 0; k < whole_vectors(count); k++) s[k] += xa[k] * Ga[k];
    }
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        const double conduction =
            pair_conduction(alpha_u, alpha_s, own_P, P[k], 0.5 * (own_rho + rho[k]));
        const double along_pair = least(s[k] * r_inverse[k], 0);
        s[k] = own_m * m[k] * conduction * (own_u - u[k]) * along_pair;
        reaction[k] -= s[k];
    }
    return lanes_sum(s, count);
}

double cells_conduction(const struct cells *cells, const struct pairs *pairs)
{
    const struct cells_method *method = &cells->method;
    return conducted(method->box.dim, method->conductivity, method->shock_conductivity, pairs);
}

ALWAYS_INLINE void approaches_in(int dim, const struct pairs *pairs, double *restrict found)
{
    const struct lanes *lanes = pairs->lanes;
    const double *own_v = pairs_own(pairs, RECORD_VELOCITY),
                 *restrict v = pairs_others(pairs, RECORD_VELOCITY),
                 *restrict G = lane(lanes, LANE_GX);
#pragma omp simd
    for (int k = 0; k < whole_vectors(pairs->count); k++)
        found[k] = approach(dim, lanes->stride, k, own_v, v, G);
}

CLONES static void approaches(int dim, const struct pairs *pairs, double *restrict found)
{
    if (dim == 2)
        approaches_in(2, pairs, found);
    else
        approaches_in(3, pairs, found);
}

double cells_divergence(const struct cells *cells, const struct pairs *pairs)
{
    double *found = lane(pairs->lanes, LANE_SPARE);
    approaches(cells->method.box.dim, pairs, found);
    return -lanes_dot(pairs_others(pairs, RECORD_VOLUME), found, pairs->count);
}
