/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "matrix.h"

#include <float.h>
#include <math.h>

#include "specialise.h"

enum { MAX = 3 };

/* Largest magnitude; NaN if a value is NaN. */
static double largest_magnitude(int n, const double *a, int stride)
{
    double m = 0;
    for (int i = 0; i < n; i++)
        if (!(fabs(a[i * stride]) <= m) && !isnan(m)) m = fabs(a[i * stride]);
    return m;
}

static double frobenius(int n, const double *a)
{
    double s = 0;
    for (int i = 0; i < n; i++) s += a[i] * a[i];
    return sqrt(s);
}

static void swap(double *a, double *b)
{
    const double t = *a;
    *a = *b;
    *b = t;
}

/* Replaces a by its inverse (Gauss-Jordan). False: zero pivot. */
static bool eliminate(int dim, double *a)
{
    int row[MAX], column[MAX];
    for (int k = 0; k < dim; k++) {
        double pivot = 0;
        row[k] = column[k] = k;
        for (int i = k; i < dim; i++)
            for (int j = k; j < dim; j++)
                if (fabs(a[i * dim + j]) > pivot)
                    pivot = fabs(a[i * dim + j]), row[k] = i, column[k] = j;
        if (!(pivot > 0)) return false;
        for (int j = 0; j < dim; j++) swap(&a[k * dim + j], &a[row[k] * dim + j]);
        for (int i = 0; i < dim; i++) swap(&a[i * dim + k], &a[i * dim + column[k]]);
        const double reciprocal = 1 / a[k * dim + k];
        a[k * dim + k] = 1;
        for (int j = 0; j < dim; j++) a[k * dim + j] *= reciprocal;
        for (int i = 0; i < dim; i++) {
            if (i == k) continue;
            const double factor = a[i * dim + k];
            a[i * dim + k] = 0;
            for (int j = 0; j < dim; j++) a[i * dim + j] -= factor * a[k * dim + j];
        }
    }
    for (int k = dim - 1; k >= 0; k--) { /* undo the exchanges, last first */
        for (int j = 0; j < dim; j++) swap(&a[k * dim + j], &a[column[k] * dim + j]);
        for (int i = 0; i < dim; i++) swap(&a[i * dim + k], &a[i * dim + row[k]]);
    }
    return true;
}

/* Inverts by cofactors if the determinant shows that nothing cancels: the usual case, five times
 * faster. Otherwise returns false and leaves inverse unchanged. */
ALWAYS_INLINE bool invert_plainly(int dim, const double *a, double *inverse)
{
    double b[MAX * MAX], c[MAX * MAX], determinant, scale = 0;
    /* without branches; a NaN may go by here, but not by the determinant */
    for (int i = 0; i < dim * dim; i++) scale = fabs(a[i]) > scale ? fabs(a[i]) : scale;
    if (!(scale > 1e-100 && scale < 1e100)) return false;
    const double unit = 1 / scale;
    for (int i = 0; i < dim * dim; i++) b[i] = a[i] * unit;
    if (dim == 1) {
        determinant = b[0], c[0] = 1;
    } else if (dim == 2) {
        determinant = b[0] * b[3] - b[1] * b[2];
        c[0] = b[3], c[1] = -b[1], c[2] = -b[2], c[3] = b[0];
    } else {
        c[0] = b[4] * b[8] - b[5] * b[7], c[1] = b[2] * b[7] - b[1] * b[8];
        c[2] = b[1] * b[5] - b[2] * b[4], c[3] = b[5] * b[6] - b[3] * b[8];
        c[4] = b[0] * b[8] - b[2] * b[6], c[5] = b[2] * b[3] - b[0] * b[5];
        c[6] = b[3] * b[7] - b[4] * b[6], c[7] = b[1] * b[6] - b[0] * b[7];
        c[8] = b[0] * b[4] - b[1] * b[3];
        determinant = b[0] * c[0] + b[1] * c[3] + b[2] * c[6];
    }
    if (!(fabs(determinant) > 1e-2)) return false;
    const double factor = 1 / (determinant * scale);
    for (int i = 0; i < dim * dim; i++) inverse[i] = c[i] * factor;
    return true;
}

bool matrix_invert(int dim, const double *a, double *inverse)
{
    if (dim == 2   ? invert_plainly(2, a, inverse)
        : dim == 3 ? invert_plainly(3, a, inverse)
                   : invert_plainly(1, a, inverse))
        return true;
    double scaled[MAX * MAX], result[MAX * MAX], r[MAX], c[MAX];
    for (int i = 0; i < dim; i++) {
        r[i] = largest_magnitude(dim, a + i * dim, 1);
        if (!(r[i] > 0 && r[i] <= DBL_MAX)) return false;
        for (int j = 0; j < dim; j++) scaled[i * dim + j] = a[i * dim + j] / r[i];
    }
    for (int j = 0; j < dim; j++) {
        c[j] = largest_magnitude(dim, scaled + j, dim);
        if (!(c[j] > 0)) return false;
        for (int i = 0; i < dim; i++)
            result[i * dim + j] = scaled[i * dim + j] = scaled[i * dim + j] / c[j];
    }
    if (!eliminate(dim, result)) return false;
    if (!(frobenius(dim * dim, scaled) * frobenius(dim * dim, result) < 1 / (16 * DBL_EPSILON)))
        return false;
    for (int i = 0; i < dim; i++)
        for (int j = 0; j < dim; j++) inverse[i * dim + j] = result[i * dim + j] / c[i] / r[j];
    return true;
}

double matrix_condition(int dim, const double *a)
{
    double u[MAX * MAX], norm[MAX];
    const double scale = largest_magnitude(dim * dim, a, 1);
    if (!(scale <= DBL_MAX)) return nan("");
    if (scale == 0) return HUGE_VAL;
    for (int i = 0; i < dim * dim; i++) u[i] = a[i] / scale;
    bool rotated = true;
    for (int sweep = 0; rotated && sweep < 30; sweep++) {
        rotated = false;
        for (int p = 0; p < dim; p++)
            for (int q = p + 1; q < dim; q++) {
                double pp = 0, qq = 0, pq = 0;
                for (int i = 0; i < dim; i++) {
                    pp += u[i * dim + p] * u[i * dim + p];
                    qq += u[i * dim + q] * u[i * dim + q];
                    pq += u[i * dim + p] * u[i * dim + q];
                }
                if (fabs(pq) <= DBL_EPSILON * sqrt(pp * qq)) continue;
                rotated = true;
                const double zeta = (qq - pp) / (2 * pq);
                const double t = copysign(1, zeta) / (fabs(zeta) + hypot(1, zeta));
                const double cosine = 1 / sqrt(1 + t * t), sine = cosine * t;
                for (int i = 0; i < dim; i++) {
                    const double x = u[i * dim + p], y = u[i * dim + q];
                    u[i * dim + p] = cosine * x - sine * y;
                    u[i * dim + q] = sine * x + cosine * y;
                }
            }
    }
    double low = HUGE_VAL, high = 0;
    for (int p = 0; p < dim; p++) {
        norm[p] = 0;
        for (int i = 0; i < dim; i++) norm[p] = hypot(norm[p], u[i * dim + p]);
        low = fmin(low, norm[p]), high = fmax(high, norm[p]);
    }
    return low > 0 ? high / low : HUGE_VAL;
}
