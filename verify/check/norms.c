/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks norms on particles with unequal volumes and known errors, for which wrong weights, a wrong
 * power or a wrong window change the result. */
#include "norm.h"

#include <gsl/gsl_qrng.h>
#include <math.h>

#include "check.h"

enum { PARTICLES = 400, CELLS = 200 };

typedef struct norms errors_function(size_t n, const double *x, const double window[2],
                                     const double *volume, const double *value,
                                     const double *exact);

struct norms_subject {
    errors_function *errors;
};

/* Cell-centred particles of unequal widths on [-1, 1]: 60 % of them in the left fifth. */
static void graded_cells(size_t n, double *x, double *volume)
{
    const size_t fine = 3 * n / 5;
    for (size_t i = 0; i < n; i++) {
        const double width = i < fine ? 0.4 / (double)fine : 1.6 / (double)(n - fine);
        x[i] =
            i < fine ? -1 + ((double)i + 0.5) * width : -0.6 + ((double)(i - fine) + 0.5) * width;
        volume[i] = width;
    }
}

/* The definitions of norm.h again, in long double and one norm at a time. */
static struct norms norms_oracle(size_t n, const double *x, const double window[2],
                                 const double *volume, const double *value, const double *exact)
{
    long double weight = 0, l1 = 0, l2 = 0, linf = 0, mean = 0;
    size_t inside = 0;
    for (size_t i = 0; i < n; i++) {
        if (x[i] < window[0] || x[i] > window[1]) continue;
        const long double error = fabsl((long double)value[i] - exact[i]);
        weight += volume[i];
        l1 += volume[i] * error;
        l2 += volume[i] * error * error;
        if (error > linf) linf = error;
        mean += error;
        inside++;
    }
    return (struct norms){.l1 = (double)(l1 / weight),
                          .l2 = (double)sqrtl(l2 / weight),
                          .linf = (double)linf,
                          .particle_mean = (double)(mean / (long double)inside),
                          .n = inside};
}

static double relative(double value, double expected)
{
    return fabs(value / expected - 1);
}

static void measure_scattered(struct check_run *run, errors_function *errors)
{
    double x[PARTICLES], volume[PARTICLES], value[PARTICLES], exact[PARTICLES], twice[PARTICLES];
    gsl_qrng *sobol = gsl_qrng_alloc(gsl_qrng_sobol, 4);
    for (size_t i = 0; i < PARTICLES; i++) {
        double u[4];
        gsl_qrng_get(sobol, u);
        x[i] = 2 * u[0] - 1;
        volume[i] = 0.002 + 0.011 * u[1] * u[1];
        exact[i] = 2.385 + u[2];
        value[i] = exact[i] + 0.37 * (u[3] - 0.7) * (1 + fabs(x[i]));
        twice[i] = exact[i] + 2 * (value[i] - exact[i]);
    }
    gsl_qrng_free(sobol);
    const double window[] = {-0.5, 0.5}, bound = 1e-13, floor = 4e-15;
    const struct norms got = errors(PARTICLES, x, window, volume, value, exact);
    const struct norms want = norms_oracle(PARTICLES, x, window, volume, value, exact);
    check_measure(run, relative(got.l1, want.l1), bound, floor, "scattered particles, L1");
    check_measure(run, relative(got.l2, want.l2), bound, floor, "scattered particles, L2");
    check_measure(run, relative(got.linf, want.linf), bound, floor, "scattered particles, Linf");
    check_measure(run, relative(got.particle_mean, want.particle_mean), bound, floor,
                  "scattered particles, particle mean");
    check_measure(run, fabs((double)got.n - (double)want.n), 0, 0, "particles in the window");

    const struct norms doubled = errors(PARTICLES, x, window, volume, twice, exact);
    check_measure(run, relative(doubled.l1, 2 * got.l1), bound, floor, "L1 of twice the error");
    check_measure(run, relative(doubled.l2, 2 * got.l2), bound, floor, "L2 of twice the error");
    check_measure(run, relative(doubled.linf, 2 * got.linf), bound, floor,
                  "Linf of twice the error");
}

/* With cells as volumes the norms are midpoint rules: error x^2 over [-1, 1] has L1 1/3, L2
 * 1/sqrt 5, Linf 1, up to the width of a cell squared. */
static void measure_integral(struct check_run *run, errors_function *errors)
{
    double x[CELLS], volume[CELLS], value[CELLS], exact[CELLS];
    graded_cells(CELLS, x, volume);
    for (size_t i = 0; i < CELLS; i++) {
        exact[i] = 1 + x[i];
        value[i] = exact[i] + (i % 2 ? 1 : -1) * x[i] * x[i];
    }
    const double widest = 1.6 / (CELLS - 3. * CELLS / 5), bound = widest * widest;
    const struct norms got = errors(CELLS, x, (double[]){-1, 1}, volume, value, exact);
    check_measure(run, fabs(got.l1 - 1. / 3), bound, bound / 10, "graded cells, L1 of x^2");
    check_measure(run, fabs(got.l2 - sqrt(0.2)), bound, bound / 10, "graded cells, L2 of x^2");
    check_measure(run, fabs(got.linf - 1), 2 * widest, widest / 10, "graded cells, Linf of x^2");
}

static void measure_fields(struct check_run *run, const void *subject)
{
    static const struct norms_subject right = {norm_errors};
    const struct norms_subject *s = subject ? subject : &right;
    measure_scattered(run, s->errors);
    measure_integral(run, s->errors);
    const double nan = (double)NAN, x[] = {0, 0.1}, ones[] = {1, 1}, value[] = {nan, 1};
    const struct norms got = s->errors(2, x, (double[]){-1, 1}, ones, value, ones);
    check_measure(run, !isnan(got.l1) + !isnan(got.l2) + !isnan(got.linf), 0, 0,
                  "a NaN among the values makes every norm NaN");
}

static struct norms without_volume(size_t n, const double *x, const double window[2],
                                   const double *volume, const double *value, const double *exact)
{
    struct norms norms = norm_errors(n, x, window, volume, value, exact);
    norms.l1 = norms.particle_mean;
    return norms;
}

static struct norms squared_l2(size_t n, const double *x, const double window[2],
                               const double *volume, const double *value, const double *exact)
{
    struct norms norms = norm_errors(n, x, window, volume, value, exact);
    norms.l2 *= norms.l2;
    return norms;
}

static struct norms everywhere(size_t n, const double *x, const double window[2],
                               const double *volume, const double *value, const double *exact)
{
    (void)window;
    return norm_errors(n, x, (double[]){-1, 1}, volume, value, exact);
}

static struct norms maximum_ignores_nan(size_t n, const double *x, const double window[2],
                                        const double *volume, const double *value,
                                        const double *exact)
{
    struct norms norms = norm_errors(n, x, window, volume, value, exact);
    norms.linf = 0;
    for (size_t i = 0; i < n; i++)
        if (x[i] >= window[0] && x[i] <= window[1] && fabs(value[i] - exact[i]) > norms.linf)
            norms.linf = fabs(value[i] - exact[i]);
    return norms;
}

static struct norms not_divided_by_volume(size_t n, const double *x, const double window[2],
                                          const double *volume, const double *value,
                                          const double *exact)
{
    struct norms norms = norm_errors(n, x, window, volume, value, exact);
    double total = 0;
    for (size_t i = 0; i < n; i++)
        if (x[i] >= window[0] && x[i] <= window[1]) total += volume[i];
    norms.l1 *= total;
    return norms;
}

static struct norms signed_errors(size_t n, const double *x, const double window[2],
                                  const double *volume, const double *value, const double *exact)
{
    struct norms norms = norm_errors(n, x, window, volume, value, exact);
    double sum = 0, total = 0;
    for (size_t i = 0; i < n; i++)
        if (x[i] >= window[0] && x[i] <= window[1]) {
            sum += volume[i] * (value[i] - exact[i]);
            total += volume[i];
        }
    norms.l1 = fabs(sum / total);
    return norms;
}

static const struct check_mutant fields_mutants[] = {
    {"l1_without_volume", "L1 is the particle mean", &(struct norms_subject){without_volume}},
    {"l2_squared", "L2 without the root", &(struct norms_subject){squared_l2}},
    {"l1_signed", "errors of either sign cancel in L1", &(struct norms_subject){signed_errors}},
    {"l1_not_normalised", "L1 not divided by the window's volume",
     &(struct norms_subject){not_divided_by_volume}},
    {"norm_without_window", "norms over the whole box", &(struct norms_subject){everywhere}},
    {"linf_ignores_nan", "the maximum skips a NaN", &(struct norms_subject){maximum_ignores_nan}},
    {0},
};

CHECK_DEFINE(
    norms, error_norms, 606,
    .property = "L1 = sum V|e| / sum V, L2 = sqrt(sum V e^2 / sum V), Linf = max|e| in the window",
    .measure = measure_fields, .mutants = fields_mutants);

typedef double binned_function(size_t n, const double *x, const double window[2],
                               const double *volume, const double *value, size_t bins,
                               const double *exact_means);

struct bins_subject {
    binned_function *binned;
    bool centres; /* exact solution at a bin's centre instead of its mean */
};

static double steep(const void *context, double x)
{
    (void)context;
    return x < 0.01 ? 1 + x * x : 0.25;
}

/* The bin of the window [-0.5, 0.5] that x lies in, or NORM_BINS. */
static size_t bin_of(double x)
{
    const double bin = floor((x + 0.5) * NORM_BINS);
    return bin >= 0 && bin < NORM_BINS ? (size_t)bin : NORM_BINS;
}

/* Particles whose volume-weighted mean in each bin differs from the exact one by exactly +-amount,
 * with scatter that depends on the volumes; bin 7 is empty, and values outside the window are far
 * off. */
static size_t scatter_bins(double amount, const double *exact_means, double *x, double *volume,
                           double *value)
{
    size_t n = 0;
    double weight[NORM_BINS + 1] = {0}, sum[NORM_BINS + 1] = {0};
    for (int i = 0; i < CELLS; i++) {
        x[n] = -1 + (i + 0.5) * 2 / CELLS;
        if (bin_of(x[n]) == 7) continue;
        volume[n] = i % 2 ? 0.015 : 0.005;
        value[n] = bin_of(x[n]) == NORM_BINS ? 40 : i % 2 ? 0.5 : -1.7;
        weight[bin_of(x[n])] += volume[n];
        sum[bin_of(x[n])] += volume[n] * value[n];
        n++;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t k = bin_of(x[i]);
        if (k < NORM_BINS)
            value[i] += exact_means[k] + (k % 2 ? amount : -amount) - sum[k] / weight[k];
    }
    return n;
}

static void measure_bins(struct check_run *run, const void *subject)
{
    static const struct bins_subject right = {norm_binned_l1, false};
    const struct bins_subject *s = subject ? subject : &right;
    const double window[] = {-0.5, 0.5}, amount = 0.0625;
    double means[NORM_BINS], x[CELLS], volume[CELLS], value[CELLS];
    norm_bin_means(steep, NULL, window, NORM_BINS, means);
    check_measure(run, relative(means[10], (0.01 * (1 + 1e-4 / 3) + 0.04 * 0.25) / 0.05), 1e-9,
                  1e-11, "mean over the bin with the jump");
    check_measure(run, relative(means[0], 1 + (0.125 - 0.091125) / 3 / 0.05), 1e-13, 4e-15,
                  "mean over a smooth bin");
    const size_t n = scatter_bins(amount, means, x, volume, value);
    for (size_t k = 0; s->centres && k < NORM_BINS; k++)
        means[k] = steep(NULL, window[0] + ((double)k + 0.5) / NORM_BINS);
    const double got = s->binned(n, x, window, volume, value, NORM_BINS, means);
    check_measure(run, relative(got, amount), 1e-12, 4e-14, "every bin off by %g, bin 7 empty",
                  amount);
}

static double empty_bins_counted(size_t n, const double *x, const double window[2],
                                 const double *volume, const double *value, size_t bins,
                                 const double *exact_means)
{
    return norm_binned_l1(n, x, window, volume, value, bins, exact_means) * 19 / 20;
}

/* The seed program's bins: 21, from one width before the window, divided by 20. */
static double one_bin_more(size_t n, const double *x, const double window[2], const double *volume,
                           const double *value, size_t bins, const double *exact_means)
{
    double means[NORM_BINS_MAX] = {exact_means[0]};
    for (size_t k = 0; k < bins; k++) means[k + 1] = exact_means[k];
    const double wider[] = {window[0] - (window[1] - window[0]) / (double)bins, window[1]};
    return norm_binned_l1(n, x, wider, volume, value, bins + 1, means) * ((double)bins + 1) /
           (double)bins;
}

static double weighted_by_number(size_t n, const double *x, const double window[2],
                                 const double *volume, const double *value, size_t bins,
                                 const double *exact_means)
{
    double ones[CELLS];
    (void)volume;
    for (size_t i = 0; i < n; i++) ones[i] = 1;
    return norm_binned_l1(n, x, window, ones, value, bins, exact_means);
}

static double twenty_one_bins(size_t n, const double *x, const double window[2],
                              const double *volume, const double *value, size_t bins,
                              const double *exact_means)
{
    (void)exact_means;
    double means[NORM_BINS + 1];
    norm_bin_means(steep, NULL, window, bins + 1, means);
    return norm_binned_l1(n, x, window, volume, value, bins + 1, means) * ((double)bins + 1) /
           (double)bins;
}

static const struct check_mutant bins_mutants[] = {
    {"bins_21_by_20", "21 bins, divided by 20", &(struct bins_subject){twenty_one_bins, false}},
    {"bin_outside_window", "a bin outside the window takes part",
     &(struct bins_subject){one_bin_more, false}},
    {"bins_weighted_by_mass", "bin means weighted by (equal) masses",
     &(struct bins_subject){weighted_by_number, false}},
    {"bins_empty_counted", "empty bins count as bins without error",
     &(struct bins_subject){empty_bins_counted, false}},
    {"bins_exact_at_centre", "exact solution at the bin's centre, not its mean",
     &(struct bins_subject){norm_binned_l1, true}},
    {0},
};

CHECK_DEFINE(norms, binned_density, 650,
             .property = "mean over the non-empty bins of |exact mean - sum V q / sum V|",
             .measure = measure_bins, .mutants = bins_mutants);
