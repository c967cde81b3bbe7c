/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "moments.h"

#include <math.h>

#include "matrix.h"
#include "specialise.h"

/* All entries of sum weight x x^T in one loop. */
ALWAYS_INLINE void squares_body(int dim, int count, ptrdiff_t stride, const double *restrict weight,
                                const double *restrict x, double *restrict sums)
{
    double xx[GRID_LANES] = {0}, xy[GRID_LANES] = {0}, yy[GRID_LANES] = {0}, xz[GRID_LANES] = {0},
           yz[GRID_LANES] = {0}, zz[GRID_LANES] = {0};
    const double *restrict y = x + stride, *restrict z = dim == 3 ? y + stride : x;
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const double wx = weight[k + l] * x[k + l], wy = weight[k + l] * y[k + l];
            xx[l] += wx * x[k + l];
            xy[l] += wx * y[k + l];
            yy[l] += wy * y[k + l];
            if (dim == 2) continue;
            xz[l] += wx * z[k + l];
            yz[l] += wy * z[k + l];
            zz[l] += weight[k + l] * z[k + l] * z[k + l];
        }
    sums[symmetric_at(dim, 0, 0)] = TREE(xx);
    sums[symmetric_at(dim, 0, 1)] = TREE(xy);
    sums[symmetric_at(dim, 1, 1)] = TREE(yy);
    if (dim == 2) return;
    sums[symmetric_at(dim, 0, 2)] = TREE(xz);
    sums[symmetric_at(dim, 1, 2)] = TREE(yz);
    sums[symmetric_at(dim, 2, 2)] = TREE(zz);
}

CLONES static void squares(int dim, int count, ptrdiff_t stride, const double *weight,
                           const double *x, double *sums)
{
    if (dim == 2)
        squares_body(2, count, stride, weight, x, sums);
    else
        squares_body(3, count, stride, weight, x, sums);
}

/* sum weight x (f - own), along all axes. */
ALWAYS_INLINE void differences_body(int dim, int count, ptrdiff_t stride,
                                    const double *restrict weight, const double *restrict x,
                                    const double *restrict f, double own, double *restrict sums)
{
    double sx[GRID_LANES] = {0}, sy[GRID_LANES] = {0}, sz[GRID_LANES] = {0};
    const double *restrict y = x + stride, *restrict z = dim == 3 ? y + stride : x;
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) {
            const double change = weight[k + l] * (f[k + l] - own);
            sx[l] += x[k + l] * change;
            sy[l] += y[k + l] * change;
            if (dim == 3) sz[l] += z[k + l] * change;
        }
    sums[0] = TREE(sx);
    sums[1] = TREE(sy);
    if (dim == 3) sums[2] = TREE(sz);
}

CLONES static void differences(int dim, int fields, int count, ptrdiff_t stride,
                               const double *weight, const double *x, const double *f,
                               const double *own, double *sums)
{
    if (dim == 2)
        for (int a = 0; a < fields; a++)
            differences_body(2, count, stride, weight, x, f + a * stride, own[a], sums + 2 * a);
    else
        for (int a = 0; a < fields; a++)
            differences_body(3, count, stride, weight, x, f + a * stride, own[a], sums + 3 * a);
}

void moments_weigh(const struct cells *cells, int count, const struct lanes *lanes,
                   double h_inverse, const double *V)
{
    cells->shapes.weights(cells->method.kernel, (size_t)count, lane(lanes, LANE_R), h_inverse, V,
                          lane(lanes, LANE_W), lane(lanes, LANE_W_J));
}

ALWAYS_INLINE bool invert(int dim, double worst, const double *sums, double *inverse,
                          double *condition)
{
    double moments[CELLS_SQUARE] = {0}, norm = 0, norm_inverse = 0;
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) moments[a * dim + b] = sums[symmetric_at(dim, a, b)];
    *condition = HUGE_VAL;
    if (!matrix_invert(dim, moments, inverse)) return false;
    for (int k = 0; k < dim * dim; k++) {
        norm += moments[k] * moments[k];
        norm_inverse += inverse[k] * inverse[k];
    }
    *condition = sqrt(norm) * sqrt(norm_inverse);
    if (!(*condition <= worst)) *condition = matrix_condition(dim, moments);
    return *condition <= worst;
}

bool moments_invert(const struct cells_method *method, int count, const struct lanes *lanes,
                    const double *weight, double inverse[CELLS_SQUARE], double *condition)
{
    const int dim = method->box.dim;
    const double worst = method->worst_condition;
    double sums[CELLS_SYMMETRIC];
    squares(dim, count, lanes->stride, weight, lane(lanes, LANE_DX), sums);
    return dim == 2 ? invert(2, worst, sums, inverse, condition)
                    : invert(3, worst, sums, inverse, condition);
}

/* gradient = sums C, row by row. */
ALWAYS_INLINE void rows_times_matrix(int dim, const double *sums, const double *inverse,
                                     double *gradient)
{
    for (int a = 0; a < dim; a++)
        for (int b = 0; b < dim; b++) {
            double g = 0;
            for (int c = 0; c < dim; c++) g += inverse[b * dim + c] * sums[a * dim + c];
            gradient[a * dim + b] = g;
        }
}

void moments_gradient(int dim, int count, const struct lanes *lanes, const double *weight,
                      const double inverse[CELLS_SQUARE], const double *f, const double *own,
                      double gradient[CELLS_SQUARE])
{
    double sums[CELLS_SQUARE];
    differences(dim, dim, count, lanes->stride, weight, lane(lanes, LANE_DX), f, own, sums);
    if (dim == 2)
        rows_times_matrix(2, sums, inverse, gradient);
    else
        rows_times_matrix(3, sums, inverse, gradient);
}

int moments_put(const struct cells_method *method, int count, const struct lanes *lanes,
                const double *weight, size_t particle, struct moments_batch *batch)
{
    const int dim = method->box.dim, l = batch->count++;
    double sums[CELLS_SYMMETRIC];
    squares(dim, count, lanes->stride, weight, lane(lanes, LANE_DX), sums);
    for (int k = 0; k < dim * (dim + 1) / 2; k++) batch->moments[k][l] = sums[k];
    batch->particle[l] = particle;
    return l;
}

void moments_put_differences(int dim, int fields, int count, const struct lanes *lanes,
                             const double *weight, const double *f, const double *own, int l,
                             double (*sums)[GRID_LANES])
{
    double found[CELLS_SQUARE];
    differences(dim, fields, count, lanes->stride, weight, lane(lanes, LANE_DX), f, own, found);
    for (int k = 0; k < fields * dim; k++) sums[k][l] = found[k];
}

/* Inverts by cofactors where the determinant shows that nothing cancels. Elsewhere the condition is
 * NaN. */
ALWAYS_INLINE void solve_body(int dim, struct moments_batch *batch)
{
    const double *restrict xx = batch->moments[0], *restrict xy = batch->moments[1],
                           *restrict xz = batch->moments[2],
                           *restrict yy = batch->moments[dim == 2 ? 2 : 3],
                           *restrict yz = batch->moments[4], *restrict zz = batch->moments[5];
    double(*restrict inverse)[GRID_LANES] = batch->inverse;
    SIMD_LANES
    for (int l = 0; l < GRID_LANES; l++) {
        const double a = xx[l], b = xy[l], c = dim == 3 ? xz[l] : 0, d = yy[l],
                     e = dim == 3 ? yz[l] : 0, f = dim == 3 ? zz[l] : 1;
        const double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d, D = a * f - c * c,
                     E = b * c - a * e, F = a * d - b * b,
                     determinant = dim == 2 ? F : a * A + b * B + c * C;
        const double trace = dim == 2 ? a + d : a + d + f,
                     volume = dim == 2 ? trace * trace : trace * trace * trace;
        /* no factor if the determinant is NaN or a product overflows */
        const double factor = fabs(determinant) > 1e-3 * volume ? 1 / determinant : (double)NAN;
        const double P = A * factor, Q = B * factor, R = C * factor, S = D * factor, T = E * factor,
                     U = F * factor;
        const double norm = a * a + d * d + 2 * (b * b), norm_inverse = P * P + S * S + 2 * (Q * Q),
                     more = c * c + e * e, more_inverse = R * R + T * T;
        inverse[0][l] = P;
        inverse[1][l] = Q;
        inverse[dim == 2 ? 2 : 3][l] = S;
        if (dim == 3) inverse[2][l] = R, inverse[4][l] = T, inverse[5][l] = U;
        batch->condition[l] =
            dim == 2 ? sqrt(norm * norm_inverse)
                     : sqrt((norm + f * f + 2 * more) * (norm_inverse + U * U + 2 * more_inverse));
    }
}

CLONES static void solve(int dim, struct moments_batch *batch)
{
    if (dim == 2)
        solve_body(2, batch);
    else
        solve_body(3, batch);
}

void moments_solve(const struct cells_method *method, struct moments_batch *batch)
{
    const int dim = method->box.dim, symmetric = dim * (dim + 1) / 2;
    if (batch->count == 0) return;
    solve(dim, batch);
    for (int l = 0; l < batch->count; l++) {
        batch->sound[l] = batch->condition[l] <= method->worst_condition;
        if (batch->sound[l]) continue;
        double sums[CELLS_SYMMETRIC], inverse[CELLS_SQUARE] = {0};
        for (int k = 0; k < symmetric; k++) sums[k] = batch->moments[k][l];
        batch->sound[l] = invert(dim, method->worst_condition, sums, inverse, &batch->condition[l]);
        for (int a = 0, k = 0; a < dim; a++)
            for (int b = a; b < dim; b++, k++)
                batch->inverse[k][l] =
                    batch->sound[l] ? 0.5 * (inverse[a * dim + b] + inverse[b * dim + a]) : 0;
    }
}

ALWAYS_INLINE void apply_body(int dim, const double (*restrict inverse)[GRID_LANES],
                              double (*restrict sums)[GRID_LANES])
{
    SIMD_LANES
    for (int l = 0; l < GRID_LANES; l++) {
        const double x = sums[0][l], y = sums[1][l];
        if (dim == 2) {
            sums[0][l] = inverse[0][l] * x + inverse[1][l] * y;
            sums[1][l] = inverse[1][l] * x + inverse[2][l] * y;
        } else {
            const double z = sums[2][l];
            sums[0][l] = inverse[0][l] * x + inverse[1][l] * y + inverse[2][l] * z;
            sums[1][l] = inverse[1][l] * x + inverse[3][l] * y + inverse[4][l] * z;
            sums[2][l] = inverse[2][l] * x + inverse[4][l] * y + inverse[5][l] * z;
        }
    }
}

CLONES static void apply(int dim, int fields, const double (*inverse)[GRID_LANES],
                         double (*sums)[GRID_LANES])
{
    for (int a = 0; a < fields; a++)
        if (dim == 2)
            apply_body(2, inverse, sums + 2 * a);
        else
            apply_body(3, inverse, sums + 3 * a);
}

void moments_apply(int dim, int fields, const struct moments_batch *batch,
                   double (*sums)[GRID_LANES])
{
    apply(dim, fields, batch->inverse, sums);
}
