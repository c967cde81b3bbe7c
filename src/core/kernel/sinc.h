/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sinc family (Cabezon, Garcia-Senz & Relano 2008), w = (sin(pi q)/(pi q))^n, n = kernel->order.
 * Without the cut-off at q = 1 its transform ends at k h = n pi, so that lattice sums are exact for
 * eta >= n/2; the cut-off leaves biases that decrease with n. sin(pi q) is computed from the nearer
 * zero, which keeps the relative accuracy up to the edge. */
#ifndef KERNEL_SINC_H
#define KERNEL_SINC_H

enum { SINC_ORDER_MIN = 3, SINC_ORDER_MAX = 12 };

/* s(q) = sin(pi q)/(pi q) and s'(q), 0 <= q < 1; below q = 0.3 s' by its series in x = (pi q)^2. */
static inline double sinc_s(double q)
{
    const double x = M_PI * q;
    return q > 0 ? sin(q < 0.5 ? x : M_PI * (1 - q)) / x : 1;
}

static inline double sinc_ds(double q)
{
    if (q < 0.3) {
        const double x = (M_PI * q) * (M_PI * q);
        double sum = 0;
        for (int k = 9; k > 0; k--) /* sum_k (-1)^k 2k x^k / (2k+1)!, by nested terms */
            sum = (1 - (k + 1) / (double)k * x / ((2 * k + 2) * (2 * k + 3)) * sum);
        return -M_PI * M_PI * q / 3 * sum;
    }
    return (cos(M_PI * q) - sinc_s(q)) / q;
}

static inline double sinc_power(double s, int n)
{
    double y = s;
    for (int i = 1; i < n; i++) y *= s;
    return y;
}

static inline double sinc_w(const struct kernel *kernel, double q, int dim)
{
    (void)dim;
    return q < 1 ? sinc_power(sinc_s(q), kernel->order) : 0;
}

static inline double sinc_dw(const struct kernel *kernel, double q, int dim)
{
    (void)dim;
    const int n = kernel->order;
    return q < 1 ? n * sinc_power(sinc_s(q), n - 1) * sinc_ds(q) : 0;
}

#endif
KERNEL(sinc, .member = {"sinc", "sinc family, (sin(pi q)/(pi q))^n", "Cabezon et al. 2008"},
       .smoothness = {0, 4, 4, 4}, .default_eta = 2.5,
       .stable_eta = {[GRADIENT_STANDARD] = 4.687, [GRADIENT_IA] = 4.886}, .order = 5)
