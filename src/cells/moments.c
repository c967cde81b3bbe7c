/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "moments.h"

#include <math.h>

#include "matrix.h"
#include "stamp.h"

CLONES static void product(int count, const double *restrict a, const double *restrict b,
                           double *restrict ab)
{
#pragma omp simd
    for (int k = 0; k < count; k++) ab[k] = a[k] * b[k];
}

CLONES static double moment(int count, const double *restrict weight, const double *restrict x,
                            const double *restrict y)
{
    double s[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) s[l] += weight[k + l] * x[k + l] * y[k + l];
    return TREE(s);
}

/* sum weight x (v - own). */
CLONES static double moment_of_difference(int count, const double *restrict weight,
                                          const double *restrict x, const double *restrict v,
                                          double own)
{
    double s[GRID_LANES] = {0};
    for (int k = 0; k < count; k += GRID_LANES)
#pragma omp simd
        for (int l = 0; l < GRID_LANES; l++) s[l] += weight[k + l] * x[k + l] * (v[k + l] - own);
    return TREE(s);
}

void moments_weigh(const struct cells *cells, int count, const struct lanes *lanes,
                   double h_inverse, const double *V)
{
    double *q = lane(lanes, LANE_Q), *w = lane(lanes, LANE_W);
    lanes_scale(count, lane(lanes, LANE_R), h_inverse, q);
    cells->shapes.w(cells->method.kernel, (size_t)count, q, w);
    product(count, V, w, lane(lanes, LANE_W_J));
}

bool moments_invert(const struct cells_method *method, int count, const struct lanes *lanes,
                    const double *weight, double inverse[CELLS_SQUARE], double *condition)
{
    const int dim = method->box.dim;
    double moments[CELLS_SQUARE] = {0};
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++)
            moments[a * dim + b] = moments[b * dim + a] =
                moment(count, weight, lane(lanes, LANE_DX + a), lane(lanes, LANE_DX + b));
    *condition = HUGE_VAL;
    if (!matrix_invert(dim, moments, inverse)) return false;
    double norm = 0, norm_inverse = 0;
    for (int k = 0; k < dim * dim; k++) {
        norm += moments[k] * moments[k];
        norm_inverse += inverse[k] * inverse[k];
    }
    *condition = sqrt(norm) * sqrt(norm_inverse);
    if (!(*condition <= method->worst_condition)) *condition = matrix_condition(dim, moments);
    return *condition <= method->worst_condition;
}

void moments_gradient(int dim, int count, const struct lanes *lanes, const double *weight,
                      const double inverse[CELLS_SQUARE], const double *f, double own,
                      double gradient[3])
{
    double sums[3];
    for (int c = 0; c < dim; c++)
        sums[c] = moment_of_difference(count, weight, lane(lanes, LANE_DX + c), f, own);
    for (int b = 0; b < dim; b++) {
        gradient[b] = 0;
        for (int c = 0; c < dim; c++) gradient[b] += inverse[b * dim + c] * sums[c];
    }
}
