/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair gradients in 2D and 3D, the one part of the pair force that knows the kernel: standard, by a
 * matrix with the weight W (ia) or -W'/r (corrected), at the widths that the scheme asks for. */
#include <math.h>

#include "sides.h"
#include "stamp.h"

/* q at the particle's own width, at the neighbour's, or at a width of both. */
CLONES static void widths(enum pair_width width, int count, const double *restrict r,
                          double h_inverse, const double *restrict theirs, double *restrict q,
                          double *restrict q_j)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        if (width == PAIR_WIDTH_MEAN) {
            q[k] = r[k] * h_inverse;
            q_j[k] = r[k] * theirs[k];
        } else {
            const double both = width == PAIR_WIDTH_MAX ? least(h_inverse, theirs[k])
                                                        : 0.5 * (h_inverse + theirs[k]);
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

/* s = C h^-(d+1) w'(q)/r (negative) from w'(q), in place; h_inverse of the particle where theirs is
 * NULL. */
CLONES static void standard_sizes(int dim, int count, double constant, double h_inverse,
                                  const double *restrict theirs, const double *restrict r_inverse,
                                  double *restrict dw)
{
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double inverse = theirs ? theirs[k] : h_inverse;
        dw[k] =
            constant * (dim == 2 ? power(inverse, 3) : power(inverse, 4)) * dw[k] * r_inverse[k];
    }
}

/* The mean of both widths' gradients in one walk, from w'(q_i) and w'(q_j): all that vanilla_ice
 * needs. */
ALWAYS_INLINE void standard_means_body(int dim, int count, double constant, double h_inverse,
                                       const double *restrict theirs, const struct lanes *lanes)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX),
                           *restrict r_inverse = lane(lanes, LANE_R_INVERSE),
                           *restrict dw = lane(lanes, LANE_W),
                           *restrict dw_j = lane(lanes, LANE_W_J);
    double *restrict G = lane(lanes, LANE_GX);
    const double own = constant * power(h_inverse, dim + 1);
#pragma omp simd
    for (int k = 0; k < count; k++) {
        const double other = constant * (dim == 2 ? power(theirs[k], 3) : power(theirs[k], 4));
        const double s = 0.5 * (own * dw[k] * r_inverse[k] + other * dw_j[k] * r_inverse[k]);
        for (int a = 0; a < dim; a++) G[a * stride + k] = s * x[a * stride + k];
    }
}

CLONES static void standard_means(int dim, int count, double constant, double h_inverse,
                                  const double *restrict theirs, const struct lanes *lanes)
{
    if (dim == 2)
        standard_means_body(2, count, constant, h_inverse, theirs, lanes);
    else
        standard_means_body(3, count, constant, h_inverse, theirs, lanes);
}

/* w(q), or -w'(q)/q from w' in place, as weight of a matrix. */
CLONES static void corrected_weight(int count, const double *restrict q, double *restrict dw)
{
#pragma omp simd
    for (int k = 0; k < count; k++) dw[k] = q[k] > 0 ? -dw[k] / q[k] : 0;
}

/* G = s x. */
CLONES static void along(int count, const double *restrict s, const double *restrict x,
                         double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < count; k++) G[k] = s[k] * x[k];
}

/* Negative gradients by matrices along all axes, G_i = -C_i x w and G_j = -C_j x w_j, and their
 * mean. */
ALWAYS_INLINE void matrix_body(int dim, int count, const struct lanes *lanes, const double *own,
                               const double *theirs)
{
    const ptrdiff_t stride = lanes->stride;
    const double *restrict x = lane(lanes, LANE_DX), *restrict C = theirs,
                           *restrict w = lane(lanes, LANE_W), *restrict w_j = lane(lanes, LANE_W_J);
    double *restrict G = lane(lanes, LANE_GX), *restrict G_i = lane(lanes, LANE_GX_I),
                     *restrict G_j = lane(lanes, LANE_GX_J);
#pragma omp simd
    for (int k = 0; k < count; k++)
        for (int a = 0; a < dim; a++) {
            double mine = 0, other = 0;
            for (int b = 0; b < dim; b++) {
                const int ab = symmetric_at(dim, a, b);
                mine -= own[ab] * x[b * stride + k];
                other -= C[ab * stride + k] * x[b * stride + k];
            }
            mine *= w[k];
            other *= w_j[k];
            G_i[a * stride + k] = mine;
            G_j[a * stride + k] = other;
            G[a * stride + k] = 0.5 * (mine + other);
        }
}

CLONES static void by_matrix(int dim, int count, const struct lanes *lanes, const double *own,
                             const double *theirs)
{
    if (dim == 2)
        matrix_body(2, count, lanes, own, theirs);
    else
        matrix_body(3, count, lanes, own, theirs);
}

CLONES static void mean(int count, const double *restrict a, const double *restrict b,
                        double *restrict m)
{
#pragma omp simd
    for (int k = 0; k < count; k++) m[k] = 0.5 * (a[k] + b[k]);
}

/* Where either matrix is not to be used, the pair's gradient is the standard one. */
CLONES static void fall_back(int count, double own, const double *restrict theirs,
                             const double *restrict s, const double *restrict x, double *restrict G)
{
#pragma omp simd
    for (int k = 0; k < count; k++) G[k] = own * theirs[k] > 0 ? G[k] : s[k] * x[k];
}

/* w(q), w'(q) or what the gradient needs of them, in place of w. */
static void pair_shapes(const struct cells *cells, int count, const double *q, double *w)
{
    const struct cells_method *method = &cells->method;
    if (method->gradient == GRADIENT_IA) {
        cells->shapes.w(method->kernel, (size_t)count, q, w);
        return;
    }
    cells->shapes.dw(method->kernel, (size_t)count, q, w);
    if (method->gradient != GRADIENT_STANDARD) corrected_weight(count, q, w);
}

/* The standard pair gradient's s, at both widths. */
static void standard_pair(const struct cells *cells, int count, const struct lanes *lanes,
                          double h_inverse, const double *theirs, double *s, double *s_j)
{
    const struct cells_method *method = &cells->method;
    const int dim = method->box.dim;
    const double C = method->kernel->constant[dim], *r_inverse = lane(lanes, LANE_R_INVERSE);
    const bool mean_width = method->pair_width == PAIR_WIDTH_MEAN;
    double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J);
    widths(method->pair_width, count, lane(lanes, LANE_R), h_inverse, theirs, q, q_j);
    cells->shapes.dw(method->kernel, (size_t)count, q, s);
    standard_sizes(dim, count, C, h_inverse, mean_width ? NULL : q_j, r_inverse, s);
    if (!mean_width) {
        for (int k = 0; k < count; k++) s_j[k] = s[k];
        return;
    }
    cells->shapes.dw(method->kernel, (size_t)count, q_j, s_j);
    standard_sizes(dim, count, C, h_inverse, theirs, r_inverse, s_j);
}

static bool all_sound(int count, double own, const double *theirs, int padding_from)
{
    double least_of = own;
    for (int k = 0; k < count; k++)
        if (k < padding_from) least_of = least(least_of, theirs[k]);
    return least_of > 0;
}

/* All of them for gradient=standard. */
static void standard_gradients(const struct cells *cells, int count, const struct lanes *lanes,
                               double h_inverse, const double *theirs)
{
    const struct cells_method *method = &cells->method;
    const int dim = method->box.dim;
    const bool both = method->formulation == FORMULATION_LAGRANGIAN;
    double *w = lane(lanes, LANE_W), *w_j = lane(lanes, LANE_W_J);
    if (!both && method->pair_width == PAIR_WIDTH_MEAN) {
        double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J);
        widths(PAIR_WIDTH_MEAN, count, lane(lanes, LANE_R), h_inverse, theirs, q, q_j);
        cells->shapes.dw(method->kernel, (size_t)count, q, w);
        cells->shapes.dw(method->kernel, (size_t)count, q_j, w_j);
        standard_means(dim, count, method->kernel->constant[dim], h_inverse, theirs, lanes);
        return;
    }
    standard_pair(cells, count, lanes, h_inverse, theirs, w, w_j);
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

/* G_i, G_j and their mean G of every pair, along every axis. */
void cells_pair_gradients(const struct cells *cells, int count, int neighbours,
                          const struct lanes *lanes, const double *record)
{
    const struct cells_method *method = &cells->method;
    const struct lanes_layout *layout = &cells->force;
    const int dim = method->box.dim;
    const double h_inverse = record[layout->offset[GROUP_GAS]];
    const double *theirs = lane_of(lanes, layout, GROUP_GAS, 0);
    double *w = lane(lanes, LANE_W), *w_j = lane(lanes, LANE_W_J);
    if (method->gradient == GRADIENT_STANDARD) {
        standard_gradients(cells, count, lanes, h_inverse, theirs);
        return;
    }
    double *q = lane(lanes, LANE_Q), *q_j = lane(lanes, LANE_Q_J);
    widths(method->pair_width, count, lane(lanes, LANE_R), h_inverse, theirs, q, q_j);
    pair_shapes(cells, count, q, w);
    if (method->pair_width == PAIR_WIDTH_MEAN)
        pair_shapes(cells, count, q_j, w_j);
    else
        for (int k = 0; k < count; k++) w_j[k] = w[k];
    const double *own = record + layout->offset[GROUP_MATRIX];
    by_matrix(dim, count, lanes, own, lane_of(lanes, layout, GROUP_MATRIX, 0));
    const int symmetric = dim * (dim + 1) / 2;
    const double *use = lane_of(lanes, layout, GROUP_MATRIX, symmetric);
    if (all_sound(count, own[symmetric], use, neighbours)) return;
    standard_pair(cells, count, lanes, h_inverse, theirs, w, w_j);
    double *s = lane(lanes, LANE_SPARE);
    mean(count, w, w_j, s);
    for (int a = 0; a < dim; a++) {
        const double *x = lane(lanes, LANE_DX + a);
        fall_back(count, own[symmetric], use, s, x, lane(lanes, LANE_GX + a));
        fall_back(count, own[symmetric], use, w, x, lane(lanes, LANE_GX_I + a));
        fall_back(count, own[symmetric], use, w_j, x, lane(lanes, LANE_GX_J + a));
    }
}
