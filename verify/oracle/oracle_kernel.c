/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "oracle_kernel.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static const long double pi = 3.14159265358979323846264338327950288L;

static long double power(long double x, int n)
{
    long double y = 1;
    while (n-- > 0) y *= x;
    return y;
}

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
        if (q < knot) w += factor_of_knot(n, k) * power(knot - q, n - 1);
    }
    return w;
}

static long double spline_dw(int n, long double q)
{
    long double dw = 0;
    for (int k = 0; 2 * k < n; k++) {
        const long double knot = 1 - 2.0L * k / n;
        if (q < knot) dw -= factor_of_knot(n, k) * (n - 1) * power(knot - q, n - 2);
    }
    return dw;
}

/* The textbook cubic, w = 1 - 6 q^2 + 6 q^3 and 2 (1-q)^3; seed page 4 prints its derivative's
 * outer branch with the wrong sign. */
static long double cubic_w(int n, long double q)
{
    (void)n;
    if (q >= 1) return 0;
    return q <= 0.5L ? 1 - 6 * q * q + 6 * q * q * q : 2 * power(1 - q, 3);
}

static long double cubic_dw(int n, long double q)
{
    (void)n;
    if (q >= 1) return 0;
    return q <= 0.5L ? -12 * q + 18 * q * q : -6 * (1 - q) * (1 - q);
}

/* Wendland functions in 1D: (1-q)^a times a polynomial, a = 3, 5, 7 for C2, C4, C6. */
static const long double wendland_terms[][4] = {
    [3] = {1, 3}, [5] = {1, 5, 8}, [7] = {1, 7, 19, 21}};

static long double wendland_w(int a, long double q)
{
    const long double *c = wendland_terms[a];
    return q < 1 ? power(1 - q, a) * (c[0] + q * (c[1] + q * (c[2] + q * c[3]))) : 0;
}

static long double wendland_dw(int a, long double q)
{
    const long double *c = wendland_terms[a];
    if (q >= 1) return 0;
    return power(1 - q, a) * (c[1] + q * (2 * c[2] + q * 3 * c[3])) -
           a * power(1 - q, a - 1) * (c[0] + q * (c[1] + q * (c[2] + q * c[3])));
}

static long double sinc_w(int n, long double q)
{
    if (q >= 1) return 0;
    const long double z = pi * q;
    return power(z < 1e-6L ? 1 - z * z / 6 : sinl(z) / z, n);
}

static long double sinc_dw(int n, long double q)
{
    if (q >= 1) return 0;
    const long double z = pi * q;
    const long double s = z < 1e-6L ? 1 - z * z / 6 : sinl(z) / z;
    const long double ds = z < 1e-4L ? -z / 3 + z * z * z / 30 : (cosl(z) - s) / z;
    return n * power(s, n - 1) * ds * pi;
}

/* 1/(2 int_0^1 w dq) by Simpson's rule: an even, smooth function whose odd derivatives vanish at
 * 0; Richardson's step removes the next term. */
static long double constant_by_quadrature(const struct oracle_kernel *kernel)
{
    long double last = 0, sum = 0;
    for (int n = 512; n <= 1024; n *= 2) {
        last = sum;
        sum = kernel->w(kernel->parameter, 0);
        for (int i = 1; i < n; i++)
            sum += (i % 2 ? 4 : 2) * kernel->w(kernel->parameter, (long double)i / n);
        sum /= 3 * n;
    }
    return 1 / (2 * (sum + (sum - last) / 15));
}

long double oracle_kernel_w(const struct oracle_kernel *kernel, long double q)
{
    if (kernel->source) return kernel->source->w(kernel->source, (double)q, 1);
    return kernel->w(kernel->parameter, q);
}

long double oracle_kernel_dw(const struct oracle_kernel *kernel, long double q)
{
    if (kernel->source) return kernel->source->dw(kernel->source, (double)q, 1);
    return kernel->dw(kernel->parameter, q);
}

/* int of (knot - q)^(n-1) from 0 to knot, summed over the knots: half of the normalisation. */
static long double spline_constant(int n)
{
    long double half = 0;
    for (int k = 0; 2 * k < n; k++) half += factor_of_knot(n, k) * power(1 - 2.0L * k / n, n) / n;
    return 1 / (2 * half);
}

struct oracle_kernel oracle_kernel_find(const struct kernel *source)
{
    static const struct {
        const char *name;
        struct oracle_kernel kernel;
    } table[] = {
        {"quadratic_spline", {0, spline_w, spline_dw, 3, NULL}},
        {"cubic_spline", {4 / 3.0L, cubic_w, cubic_dw, 4, NULL}},
        {"quartic_spline", {0, spline_w, spline_dw, 5, NULL}},
        {"quintic_spline", {0, spline_w, spline_dw, 6, NULL}},
        {"wendland_c2", {5 / 4.0L, wendland_w, wendland_dw, 3, NULL}},
        {"wendland_c4", {3 / 2.0L, wendland_w, wendland_dw, 5, NULL}},
        {"wendland_c6", {55 / 32.0L, wendland_w, wendland_dw, 7, NULL}},
        {"sinc", {0, sinc_w, sinc_dw, 5, NULL}},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        if (strcmp(source->member.name, table[i].name) != 0) continue;
        struct oracle_kernel kernel = table[i].kernel;
        if (kernel.w == sinc_w) {
            kernel.parameter = source->order;
            kernel.constant = constant_by_quadrature(&kernel);
        } else if (kernel.constant == 0) {
            kernel.constant = spline_constant(kernel.parameter);
        }
        return kernel;
    }
    return (struct oracle_kernel){.constant = source->constant[1], .source = source};
}
