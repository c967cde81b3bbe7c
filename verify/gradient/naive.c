/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "naive.h"

#include <math.h>

typedef long double real;

struct pair {
    real V, x[3], r, W, dW; /* x = r_j - r_i; W and dW/dr in full */
    real f;
};

static real power(real x, int n)
{
    real y = 1;
    for (int i = 0; i < n; i++) y *= x;
    return y;
}

static bool pair_load(struct pair *pair, const struct kernel *kernel, enum naive_fault fault,
                      const struct cloud *cloud, const double *f, size_t i, size_t j)
{
    const int dim = cloud->points.dim;
    real r2 = 0, h = cloud->h[fault == NAIVE_WIDTH_OF_NEIGHBOUR ? j : i];
    double shift[3] = {0}, d2 = 0; /* to the nearest image, in double precision */
    for (int a = 0; a < dim; a++) {
        const double d = cloud->points.x[a][j] - cloud->points.x[a][i];
        const double length =
            cloud->points.periodic ? cloud->points.hi[a] - cloud->points.lo[a] : 0;
        shift[a] = d > 0.5 * length ? -length : d < -0.5 * length ? length : 0;
        d2 += (d + shift[a]) * (d + shift[a]);
    }
    if (d2 > 1.001 * (double)(h * h)) return false;
    if (fault == NAIVE_WIDTH_1D) h *= power(powl(cloud->volume[i], 1 / (real)dim), dim - 1);
    for (int a = 0; a < dim; a++) {
        pair->x[a] = (real)cloud->points.x[a][j] - cloud->points.x[a][i];
        pair->x[a] += shift[a];
        r2 += pair->x[a] * pair->x[a];
    }
    pair->r = sqrtl(r2);
    if (!(pair->r < h * (fault == NAIVE_SHORT_SUPPORT ? 0.9L : 1))) return false;
    const double q = (double)(pair->r / h);
    const real C = kernel->constant[dim] / power(h, dim);
    pair->W = C * kernel->w(kernel, q, dim);
    pair->dW = C / (fault == NAIVE_POWER_OF_H ? 1 : h) * kernel->dw(kernel, q, dim);
    pair->V = cloud->volume[j];
    pair->f = f[j];
    if (fault == NAIVE_FLOAT) {
        pair->W = (float)pair->W, pair->dW = (float)pair->dW;
        for (int a = 0; a < dim; a++) pair->x[a] = (float)pair->x[a];
    }
    if (fault == NAIVE_HALF && j < i) return false;
    return true;
}

/* Inverse by cofactors; padded to 3x3 with ones on the diagonal. */
static bool invert(int dim, enum naive_fault fault, real m[3][3], real out[3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            if (a >= dim || b >= dim) m[a][b] = a == b;
            if (fault == NAIVE_DIAGONAL && a != b) m[a][b] = 0;
        }
    real determinant = 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const int i = (a + 1) % 3, j = (a + 2) % 3, k = (b + 1) % 3, l = (b + 2) % 3;
            out[b][a] = m[i][k] * m[j][l] - m[i][l] * m[j][k];
        }
    for (int b = 0; b < 3; b++) {
        const real term = m[0][b] * out[b][0];
        determinant += fault == NAIVE_DETERMINANT_SIGN && b == 1 ? -term : term;
    }
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            out[a][b] /= determinant;
            if (fault == NAIVE_IDENTITY) out[a][b] = a == b;
        }
    if (fault == NAIVE_TRANSPOSED)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < a; b++) {
                const real t = out[a][b];
                out[a][b] = out[b][a], out[b][a] = t;
            }
    return determinant != 0;
}

void naive_gradient(const struct operator_form *form, const struct kernel *kernel,
                    enum naive_fault fault, const struct cloud *cloud, const double *f, size_t i,
                    double *gradient)
{
    const int dim = cloud->points.dim;
    const bool normalised =
        form->pair_vector == VECTOR_NORMALISED && fault != NAIVE_NO_NORMALISATION;
    const bool corrected = form->corrected && fault != NAIVE_NO_GRADIENT_CORRECTION;
    struct pair pair;
    real S = 0, K[3] = {0};
    for (size_t j = 0; normalised && j < cloud->points.n; j++) {
        if (!pair_load(&pair, kernel, fault, cloud, f, i, j)) continue;
        if (fault != NAIVE_SELF_WITHOUT || j != i) S += pair.V * pair.W;
        for (int a = 0; a < dim && pair.r > 0; a++) K[a] -= pair.V * pair.x[a] / pair.r * pair.dW;
    }
    if (fault == NAIVE_NO_NORMALISATION_GRADIENT)
        for (int a = 0; a < dim; a++) K[a] = 0;
    real sum[3] = {0}, matrix[3][3] = {{0}}, inverse[3][3] = {{0}};
    for (size_t j = 0; j < cloud->points.n; j++) {
        if (!pair_load(&pair, kernel, fault, cloud, f, i, j)) continue;
        const bool subtracted = form->difference && !normalised;
        const real value = pair.f - (subtracted && fault != NAIVE_NO_SUBTRACTION ? f[i] : 0);
        for (int a = 0; a < dim; a++) {
            const real slope = pair.r > 0 ? -pair.x[a] / pair.r * pair.dW : 0;
            real p = form->pair_vector == VECTOR_POSITION ? pair.x[a] * pair.W : slope;
            if (normalised) p = (slope - pair.W / S * K[a]) / S;
            if (fault == NAIVE_SIGN) p = -p;
            sum[a] += pair.V * value * p;
            for (int b = 0; b < dim; b++)
                matrix[a][b] += (fault == NAIVE_NO_VOLUME ? 1 : pair.V) *
                                (fault == NAIVE_SIGN ? -p : p) *
                                (fault == NAIVE_ABSOLUTE ? cloud->points.x[b][j] : pair.x[b]);
        }
    }
    const bool ok = !corrected || invert(dim, fault, matrix, inverse);
    for (int a = 0; a < dim; a++) {
        real g = corrected ? 0 : sum[a];
        for (int b = 0; corrected && b < dim; b++) g += inverse[a][b] * sum[b];
        gradient[a] = ok ? (double)g : (double)NAN;
    }
}
