/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair gradients in 2D and 3D, the only part of the pair force that evaluates the kernel: standard,
 * by a matrix with the gradient's weight, or a blend of both with each particle's weight; at the
 * smoothing lengths that the scheme prescribes. */
#include <math.h>

#include "pairs.h"
#include "specialise.h"

/* q with h_i and with h_j; if the pair has one common h, q is for this h and q_j holds 1/h. */
CLONES static void widths(enum pair_width width, int count, const double *restrict r,
                          double h_inverse, const double *restrict others, double *restrict q,
                          double *restrict q_j)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        if (width == PAIR_WIDTH_MEAN) {
            q[k] = r[k] * h_inverse;
            q_j[k] = r[k] * others[k];
        } else {
            const double both = width == PAIR_WIDTH_MAX ? least(h_inverse, others[k])
                                                        : 0.5 * (h_inverse + others[k]);
            q[k] = r[k] * both;
            q_j[k] = both;
        }
    }
}

ALWAYS_INLINE double power(double x, int n)
{
    double y = x;
    for (int k = 1; k < n; k++) y *= x;
    return y;
}

/* Replaces w'(q) by s = C h^-(d+1) w'(q)/r (negative). others: 1/h of each pair; NULL: h_inverse
 * for all. */
CLONES static void standard_sizes(int dim, int count, double constant, double h_inverse,
                                  const double *restrict others, const double *restrict r_inverse,
                                  double *restrict dw)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        const double inverse = others ? others[k] : h_inverse;
        dw[k] =
            constant * (dim == 2 ? power(inverse, 3) : power(inverse, 4)) * dw[k] * r_inverse[k];
    }
}

/* The mean of the gradients at h_i and h_j in one loop, from w'(q_i) and w'(q_j); vanilla_ice needs
 * nothing else. */
ALWAYS_INLINE void standard_means_body(int dim, int count, double constant, double h_inverse,
                                       const double *restrict others, const struct lanes *lanes)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX),
                           *restrict r_inverse = lane(lanes, LANE_R_INVERSE),
                           *restrict dw = lane(lanes, LANE_W),
                           *restrict dw_j = lane(lanes, LANE_W_J);
    double *restrict G = lane(lanes, LANE_GX);
    const double own = constant * power(h_inverse, dim + 1);
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        const double other = constant * (dim == 2 ? power(others[k], 3) : power(others[k], 4));
        const double s = 0.5 * (own * dw[k] * r_inverse[k] + other * dw_j[k] * r_inverse[k]);
        for (int a = 0; a < dim; a++) G[a * stride + k] = s * x[a * stride + k];
    }
}

CLONES static void standard_means(int dim, int count, double constant, double h_inverse,
                                  const double *restrict others, const struct lanes *lanes)
{
    if (dim == 2)
        standard_means_body(2, count, constant, h_inverse, others, lanes);
    else
        standard_means_body(3, count, constant, h_inverse, others, lanes);
}

/* Replaces w(q) by the matrix weight, computed from w'(q). */
ALWAYS_INLINE void weigh_body(enum gradient gradient, int count, const double *restrict q,
                              const double *restrict dw, double *restrict w)
{
    const bool by_both = gradient_of[gradient].weight == WEIGHT_BOTH;
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++)
        w[k] = gradient_weight(gradient, by_both ? w[k] : 0, q[k] > 0 ? -dw[k] / q[k] : 0);
}

#define WEIGH(symbol, name, ...)                                                                   \
    case symbol:                                                                                   \
        if (gradient_of[symbol].weight > WEIGHT_W) weigh_body(symbol, count, q, dw, w);            \
        break;
CLONES static void weigh_pairs(enum gradient gradient, int count, const double *restrict q,
                               const double *restrict dw, double *restrict w)
{
    switch (gradient) {
        GRADIENT_LIST(WEIGH, )
    }
}

/* G = s x. */
CLONES static void along(int count, const double *restrict s, const double *restrict x,
                         double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) G[k] = s[k] * x[k];
}

/* Arguments of matrix_along: lanes, and the matrices of the particle (own) and of its neighbours
 * (others). */
struct by_matrices {
    const double *x, *w, *w_j, *own, *others;
    double *G, *G_i, *G_j;
    ptrdiff_t stride;
};

/* Along one axis: the mean of G_i = -C_i x w and G_j = -C_j x w_j; G_i and G_j themselves if
 * `both`. The caller writes out the axes: nested loops would not be vectorised. */
ALWAYS_INLINE void matrix_along(int dim, bool both, int a, ptrdiff_t n, const struct by_matrices *m)
{
    const double *restrict x = m->x, *restrict C = m->others, *restrict w = m->w,
                           *restrict w_j = m->w_j;
    double *restrict G = m->G, *restrict G_i = m->G_i, *restrict G_j = m->G_j;
    const ptrdiff_t stride = m->stride;
    const double half_i = -0.5 * w[n], half_j = -0.5 * w_j[n];
    double g = 0, mine = 0, other = 0;
    for (int b = 0; b < dim; b++) {
        const int ab = symmetric_at(dim, a, b);
        const double by_i = m->own[ab] * half_i, by_j = C[ab * stride + n] * half_j,
                     xb = x[b * stride + n];
        g += (by_i + by_j) * xb;
        mine += by_i * xb;
        other += by_j * xb;
    }
    G[a * stride + n] = g;
    if (!both) return;
    G_i[a * stride + n] = 2 * mine;
    G_j[a * stride + n] = 2 * other;
}

/* Negative matrix gradients along all axes. */
ALWAYS_INLINE void matrix_body(int dim, bool both, int count, const struct lanes *lanes,
                               const double *own, const double *others)
{
    const struct by_matrices m = {.x = lane(lanes, LANE_DX),
                                  .w = lane(lanes, LANE_W),
                                  .w_j = lane(lanes, LANE_W_J),
                                  .own = own,
                                  .others = others,
                                  .G = lane(lanes, LANE_GX),
                                  .G_i = lane(lanes, LANE_GX_I),
                                  .G_j = lane(lanes, LANE_GX_J),
                                  .stride = lanes->stride};
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        matrix_along(dim, both, 0, k, &m);
        matrix_along(dim, both, 1, k, &m);
        if (dim == 3) matrix_along(dim, both, 2, k, &m);
    }
}

CLONES static void by_matrix(int dim, bool both, int count, const struct lanes *lanes,
                             const double *own, const double *others)
{
    if (dim == 2 && both)
        matrix_body(2, true, count, lanes, own, others);
    else if (dim == 2)
        matrix_body(2, false, count, lanes, own, others);
    else if (both)
        matrix_body(3, true, count, lanes, own, others);
    else
        matrix_body(3, false, count, lanes, own, others);
}

/* Number of positive values. */
CLONES static int positive(int count, const double *restrict values)
{
    int found = 0;
#pragma omp simd reduction(+ : found)
    for (int k = 0; k < whole_vectors(count); k++) found += values[k] > 0 ? 1 : 0;
    return found;
}

CLONES static void mean(int count, const double *restrict a, const double *restrict b,
                        double *restrict m)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) m[k] = 0.5 * (a[k] + b[k]);
}

/* Weight of the standard gradient for each pair: 1 if either matrix is unusable, otherwise the mean
 * of the particles' weights (NULL: 0). */
CLONES static void standard_shares(int count, double own, const double *restrict others,
                                   double own_share, const double *restrict shares,
                                   double *restrict part)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++) {
        const double mean_share = shares ? 0.5 * (own_share + shares[k]) : 0;
        part[k] = least(own, others[k]) > 0 ? mean_share : 1;
    }
}

/* G = (1 - part) G + part s x. */
CLONES static void blend(int count, const double *restrict part, const double *restrict s,
                         const double *restrict x, double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < whole_vectors(count); k++)
        G[k] = (1 - part[k]) * G[k] + part[k] * (s[k] * x[k]);
}

/* w(q) or w'(q) at h_i and h_j. */
static void pair_shapes(const struct cells *cells, const struct pairs *pairs, bool by_w,
                        double *shape, double *shape_j)
{
    const struct cells_method *method = &cells->method;
    const struct shapes *shapes = &cells->shapes;
    const struct lanes *lanes = pairs->lanes;
    const double h_inverse = *pairs_own(pairs, RECORD_H_INVERSE),
                 *others = pairs_others(pairs, RECORD_H_INVERSE), *r = lane(lanes, LANE_R);
    if (method->pair_width == PAIR_WIDTH_MEAN) {
        (by_w ? shapes->pair_w : shapes->pair_dw)(method->kernel, (size_t)pairs->count, r,
                                                  h_inverse, others, shape, shape_j);
        return;
    }
    double *q = lane(lanes, LANE_Q);
    widths(method->pair_width, pairs->count, r, h_inverse, others, q, lane(lanes, LANE_Q_J));
    (by_w ? shapes->w : shapes->dw)(method->kernel, (size_t)pairs->count, q, shape);
    for (int k = 0; k < pairs->count; k++) shape_j[k] = shape[k];
}

/* Writes s of the standard gradient at h_i and h_j to LANE_W and LANE_W_J. */
static void standard_pair(const struct cells *cells, const struct pairs *pairs)
{
    const struct cells_method *method = &cells->method;
    const struct lanes *lanes = pairs->lanes;
    const int dim = method->box.dim, count = pairs->count;
    const double C = method->kernel->constant[dim], *r_inverse = lane(lanes, LANE_R_INVERSE),
                 h_inverse = *pairs_own(pairs, RECORD_H_INVERSE),
                 *others = pairs_others(pairs, RECORD_H_INVERSE);
    const bool mean_width = method->pair_width == PAIR_WIDTH_MEAN;
    double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J), *s = lane(lanes, LANE_W),
           *s_j = lane(lanes, LANE_W_J);
    widths(method->pair_width, count, lane(lanes, LANE_R), h_inverse, others, q, q_j);
    cells->shapes.dw(method->kernel, (size_t)count, q, s);
    standard_sizes(dim, count, C, h_inverse, mean_width ? NULL : q_j, r_inverse, s);
    if (!mean_width) {
        for (int k = 0; k < count; k++) s_j[k] = s[k];
        return;
    }
    cells->shapes.dw(method->kernel, (size_t)count, q_j, s_j);
    standard_sizes(dim, count, C, h_inverse, others, r_inverse, s_j);
}

/* All pair gradients with gradient=standard. */
static void standard_gradients(const struct cells *cells, const struct pairs *pairs)
{
    const struct cells_method *method = &cells->method;
    const struct lanes *lanes = pairs->lanes;
    const int dim = method->box.dim, count = pairs->count;
    const bool both = method->formulation == FORMULATION_LAGRANGIAN;
    double *w = lane(lanes, LANE_W), *w_j = lane(lanes, LANE_W_J);
    if (!both && method->pair_width == PAIR_WIDTH_MEAN) {
        pair_shapes(cells, pairs, false, w, w_j);
        standard_means(dim, count, method->kernel->constant[dim],
                       *pairs_own(pairs, RECORD_H_INVERSE), pairs_others(pairs, RECORD_H_INVERSE),
                       lanes);
        return;
    }
    standard_pair(cells, pairs);
    double *s = lane(lanes, LANE_SPARE);
    mean(count, w, w_j, s);
    for (int a = 0; a < dim; a++) {
        const double *x = lane(lanes, LANE_DX + a);
        along(count, s, x, lane(lanes, LANE_GX + a));
        if (!both) continue;
        along(count, w, x, lane(lanes, LANE_GX_I + a));
        along(count, w_j, x, lane(lanes, LANE_GX_J + a));
    }
}

/* Writes the matrix weights at h_i and h_j to LANE_W and LANE_W_J. */
static void matrix_weights(const struct cells *cells, const struct pairs *pairs)
{
    const struct lanes *lanes = pairs->lanes;
    const enum pair_width width = cells->method.pair_width;
    const enum gradient gradient = cells->method.gradient;
    const enum gradient_weight weight = gradient_of[gradient].weight;
    double *w = lane(lanes, LANE_W), *w_j = lane(lanes, LANE_W_J), *q = lane(lanes, LANE_Q),
           *q_j = lane(lanes, LANE_Q_J), *dw = lane(lanes, LANE_SLOPE_I),
           *dw_j = lane(lanes, LANE_SLOPE_J);
    if (weight != WEIGHT_SLOPE) pair_shapes(cells, pairs, true, w, w_j);
    if (weight == WEIGHT_W) return;
    pair_shapes(cells, pairs, false, dw, dw_j);
    widths(width, pairs->count, lane(lanes, LANE_R), *pairs_own(pairs, RECORD_H_INVERSE),
           pairs_others(pairs, RECORD_H_INVERSE), q, q_j);
    weigh_pairs(gradient, pairs->count, q, dw, w);
    weigh_pairs(gradient, pairs->count, width == PAIR_WIDTH_MEAN ? q_j : q, dw_j, w_j);
}

void cells_pair_gradients(const struct cells *cells, const struct pairs *pairs)
{
    const struct cells_method *method = &cells->method;
    const struct lanes *lanes = pairs->lanes;
    const int dim = method->box.dim, count = pairs->count;
    if (gradient_of[method->gradient].weight == WEIGHT_NONE) {
        standard_gradients(cells, pairs);
        return;
    }
    const bool both = method->formulation == FORMULATION_LAGRANGIAN;
    const double *own = pairs_own(pairs, RECORD_MATRIX),
                 *others = pairs_others(pairs, RECORD_MATRIX);
    matrix_weights(cells, pairs);
    by_matrix(dim, both, count, lanes, own, others);
    const bool blended = gradient_of[method->gradient].share;
    const double own_share = blended ? *pairs_own(pairs, RECORD_STEEP) : 0,
                 *shares = blended ? pairs_others(pairs, RECORD_STEEP) : NULL;
    /* the first entry is positive in a usable matrix, 0 in an unusable one */
    const bool all_sound = cells->all_sound || (own[0] > 0 && positive(count, others) == count),
               any_steep = blended && (own_share > 0 || positive(count, shares) > 0);
    if (all_sound && !any_steep) return;
    double *part = lane(lanes, LANE_K);
    standard_shares(count, own[0], others, own_share, shares, part);
    standard_pair(cells, pairs);
    double *s = lane(lanes, LANE_SPARE), *s_i = lane(lanes, LANE_W), *s_j = lane(lanes, LANE_W_J);
    mean(count, s_i, s_j, s);
    for (int a = 0; a < dim; a++) {
        const double *x = lane(lanes, LANE_DX + a);
        blend(count, part, s, x, lane(lanes, LANE_GX + a));
        if (!both) continue;
        blend(count, part, s_i, x, lane(lanes, LANE_GX_I + a));
        blend(count, part, s_j, x, lane(lanes, LANE_GX_J + a));
    }
}
