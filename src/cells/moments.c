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

double moments_slope(int dim, int count, const struct lanes *lanes, const double *weight,
                     const double inverse[CELLS_SQUARE], const double *f, double own,
                     double slope[3])
{
    double sums[3], square = 0;
    differences(dim, 1, count, lanes->stride, weight, lane(lanes, LANE_DX), f, &own, sums);
    for (int a = 0; a < dim; a++) {
        double g = 0;
        for (int b = 0; b < dim; b++) g += inverse[a * dim + b] * sums[b];
        slope[a] = g;
        square += g * g;
    }
    return sqrt(square);
}
