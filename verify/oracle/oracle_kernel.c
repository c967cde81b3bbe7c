/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle_kernel.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define pi 3.14159265358979323846264338327950288L

static long double factor_of_knot(int n, int k)
{
    long double binomial = 1;
    for (int i = 0; i < k; i++) binomial = binomial * (n - i) / (i + 1);
    return k % 2 ? -binomial : binomial;
}

/* B-spline M_n of support [-1, 1]: divided difference of truncated powers, knots 1 - 2k/n. */
static long double spline_w(int n, long double q)
{
    long double w = 0;
    for (int k = 0; 2 * k < n; k++) {
        const long double knot = 1 - 2.0L * k / n;
        if (q < knot) w += factor_of_knot(n, k) * oracle_power(knot - q, n - 1);
    }
    return w;
}

static long double spline_dw(int n, long double q)
{
    long double dw = 0;
    for (int k = 0; 2 * k < n; k++) {
        const long double knot = 1 - 2.0L * k / n;
        if (q < knot) dw -= factor_of_knot(n, k) * (n - 1) * oracle_power(knot - q, n - 2);
    }
    return dw;
}

/* The textbook cubic, w = 1 - 6 q^2 + 6 q^3 and 2 (1-q)^3; seed page 4 prints its derivative's
 * outer branch with the wrong sign. */
static long double cubic_w(int n, long double q)
{
    (void)n;
    if (q >= 1) return 0;
    return q <= 0.5L ? 1 - 6 * q * q + 6 * q * q * q : 2 * oracle_power(1 - q, 3);
}

static long double cubic_dw(int n, long double q)
{
    (void)n;
    if (q >= 1) return 0;
    return q <= 0.5L ? -12 * q + 18 * q * q : -6 * (1 - q) * (1 - q);
}

/* Wendland functions: (1-q)^a times a polynomial, a = 3, 5, 7 for C2, C4, C6 in 1D, one more in 2D
 * and 3D. */
static const long double wendland_terms[][4] = {
    [3] = {1, 3}, [5] = {1, 5, 8},         [7] = {1, 7, 19, 21},
    [4] = {1, 4}, [6] = {1, 6, 35 / 3.0L}, [8] = {1, 8, 25, 32}};

static long double wendland_w(int a, long double q)
{
    const long double *c = wendland_terms[a];
    return q < 1 ? oracle_power(1 - q, a) * (c[0] + q * (c[1] + q * (c[2] + q * c[3]))) : 0;
}

static long double wendland_dw(int a, long double q)
{
    const long double *c = wendland_terms[a];
    if (q >= 1) return 0;
    return oracle_power(1 - q, a) * (c[1] + q * (2 * c[2] + q * 3 * c[3])) -
           a * oracle_power(1 - q, a - 1) * (c[0] + q * (c[1] + q * (c[2] + q * c[3])));
}

static long double sinc_w(int n, long double q)
{
    if (q >= 1) return 0;
    const long double z = pi * q;
    return oracle_power(z < 1e-6L ? 1 - z * z / 6 : sinl(z) / z, n);
}

static long double sinc_dw(int n, long double q)
{
    if (q >= 1) return 0;
    const long double z = pi * q;
    const long double s = z < 1e-6L ? 1 - z * z / 6 : sinl(z) / z;
    const long double ds = z < 1e-4L ? -z / 3 + z * z * z / 30 : (cosl(z) - s) / z;
    return n * oracle_power(s, n - 1) * ds * pi;
}

/* S_d: surface of the unit sphere. */
static long double sphere(int dim)
{
    return dim == 1 ? 2 : dim == 2 ? 2 * pi : 4 * pi;
}

/* 1/(S_d int_0^1 q^(d-1) w dq) by Simpson's rule, with Richardson's step for its next term. */
static long double constant_by_quadrature(const struct oracle_kernel *kernel, int dim)
{
    long double last = 0, sum = 0;
    for (int n = 512; n <= 1024; n *= 2) {
        last = sum;
        sum = dim == 1 ? kernel->w(kernel->parameter, 0) : 0;
        for (int i = 1; i < n; i++) {
            const long double q = (long double)i / n;
            sum += (i % 2 ? 4 : 2) * oracle_power(q, dim - 1) * kernel->w(kernel->parameter, q);
        }
        sum /= 3 * n;
    }
    return 1 / (sphere(dim) * (sum + (sum - last) / 15));
}

long double oracle_kernel_w(const struct oracle_kernel *kernel, long double q)
{
    if (kernel->source) return kernel->source->w(kernel->source, (double)q, kernel->dim);
    return kernel->w(kernel->parameter, q);
}

long double oracle_kernel_dw(const struct oracle_kernel *kernel, long double q)
{
    if (kernel->source) return kernel->source->dw(kernel->source, (double)q, kernel->dim);
    return kernel->dw(kernel->parameter, q);
}

/* int_0^a q^(d-1) (a - q)^(n-1) dq = a^(n+d-1) (d-1)! (n-1)!/(n+d-1)!, summed over the knots a. */
static long double spline_constant(int n, int dim)
{
    long double sum = 0, beta = 1.0L / n;
    for (int k = 1; k < dim; k++) beta *= (long double)k / (n + k);
    for (int k = 0; 2 * k < n; k++)
        sum += factor_of_knot(n, k) * oracle_power(1 - 2.0L * k / n, n + dim - 1) * beta;
    return 1 / (sphere(dim) * sum);
}

struct oracle_kernel oracle_kernel_find(const struct kernel *source, int dim)
{
    static const struct {
        const char *name;
        long double (*w)(int parameter, long double q), (*dw)(int parameter, long double q);
        int parameter[4];        /* in each dimension */
        long double constant[4]; /* 0: to be found */
    } table[] = {
        {"quadratic_spline", spline_w, spline_dw, {0, 3, 3, 3}, {0}},
        {"cubic_spline", cubic_w, cubic_dw, {0}, {0, 4 / 3.0L, 40 / (7 * pi), 8 / pi}},
        {"quartic_spline", spline_w, spline_dw, {0, 5, 5, 5}, {0}},
        {"quintic_spline", spline_w, spline_dw, {0, 6, 6, 6}, {0}},
        {"wendland_c2",
         wendland_w,
         wendland_dw,
         {0, 3, 4, 4},
         {0, 5 / 4.0L, 7 / pi, 21 / (2 * pi)}},
        {"wendland_c4", wendland_w, wendland_dw, {0, 5, 6, 6}, {0, 1.5L, 9 / pi, 495 / (32 * pi)}},
        {"wendland_c6",
         wendland_w,
         wendland_dw,
         {0, 7, 8, 8},
         {0, 55 / 32.0L, 78 / (7 * pi), 1365 / (64 * pi)}},
        {"sinc", sinc_w, sinc_dw, {0}, {0}},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        if (strcmp(source->member.name, table[i].name) != 0) continue;
        struct oracle_kernel kernel = {.constant = table[i].constant[dim],
                                       .w = table[i].w,
                                       .dw = table[i].dw,
                                       .parameter = table[i].parameter[dim],
                                       .dim = dim};
        if (kernel.w == sinc_w) {
            kernel.parameter = source->order;
            kernel.constant = constant_by_quadrature(&kernel, dim);
        } else if (kernel.constant == 0) {
            kernel.constant = spline_constant(kernel.parameter, dim);
        }
        return kernel;
    }
    return (struct oracle_kernel){.constant = source->constant[dim], .dim = dim, .source = source};
}
