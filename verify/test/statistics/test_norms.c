/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests norms and bins at their limits. (The checks `norms` test the definitions.) */
#include "test.h"

#include <gsl/gsl_errno.h>

#include "norm.h"
#include "worst.h"

TEST(norms_of_nothing_and_nan)
{
    const double x[] = {0, 0.25}, volume[] = {1, 1}, exact[] = {0, 0}, window[] = {-1, 1};
    struct norms norms = norm_errors(2, x, window, volume, (double[]){NAN, 0.5}, exact);
    assert_true(isnan(norms.particle_mean));
    norms = norm_errors(2, x, (double[]){2, 3}, volume, exact, exact);
    assert_true(isnan(norms.l1) && isnan(norms.linf) && isnan(norms.particle_mean));
    norms = norm_errors(2, (double[]){NAN, 0.5}, window, volume, exact, exact);
    assert_true(isnan(norms.l1) && isnan(norms.linf));
}

static double step(const void *at, double x)
{
    return x < *(const double *)at ? 1 : 3;
}

TEST(means_of_bins)
{
    const double window[] = {-0.5, 0.5}, at = 0.0371;
    double means[NORM_BINS + 1] = {[NORM_BINS] = 7};
    norm_bin_means(step, &at, window, NORM_BINS, means);
    assert_true(means[NORM_BINS] == 7);
    near_relative(means[9], 1, 1e-12);
    near_relative(means[10], 3 - 2 * at / 0.05, 1e-9);
    near_relative(means[11], 3, 1e-12);

    const double x[] = {-0.5, -0.46, 0.5, 0.6}, volume[] = {1, 3, 1, 1}, value[] = {2, 4, 3.5, 9};
    near_relative(norm_binned_l1(4, x, window, volume, value, NORM_BINS, means),
                  ((2. + 12) / 4 - 1 + 0.5) / 2, 1e-14);
    assert_true(isnan(norm_binned_l1(0, x, window, volume, value, NORM_BINS, means)));
    const double out[] = {-0.46, -0.6, -0.7}; /* one in the window, and lower ones */
    near_relative(norm_binned_l1(2, out, window, volume, value, NORM_BINS, means), 2 - 1, 1e-14);
    /* a position that is NaN makes the norm NaN at any index; elements after the last do not
     * count */
    const double lost[] = {NAN, 0, 0.25, NAN};
    assert_true(isnan(norm_binned_l1(2, lost, window, volume, value, NORM_BINS, means)));
    assert_true(isfinite(norm_binned_l1(2, lost + 1, window, volume, value, NORM_BINS, means)));
    assert_true(isnan(norm_binned_l1(2, lost + 2, window, volume, value, NORM_BINS, means)));
}

TEST(worst_particle)
{
    double worst = 0;
    worst_keep(&worst, 2);
    worst_keep(&worst, 1);
    near_relative(worst, 2, 1e-15);
    worst_keep(&worst, NAN);
    worst_keep(&worst, 3);
    assert_true(isnan(worst));
}

/* A position that is NaN makes every norm NaN, at any index; exact values have norms of 0;
 * particles outside of the window do not count, even if their value is NaN. */
TEST(norms_at_their_limits)
{
    const double window[] = {0, 2}, volume[] = {0.5, 0.5, 0.5}, exact[] = {3, 4, 5};
    struct norms norms = norm_errors(2, (double[]){0.5, 1}, window, volume, exact, exact);
    assert_true(norms.l1 == 0 && norms.l2 == 0 && norms.linf == 0 && norms.particle_mean == 0);
    norms = norm_errors(2, (double[]){0.5, 1}, window, volume, (double[]){4, 6}, exact);
    near_relative(norms.l1, 1.5, 1e-15);
    assert_true(norms.l1_whole == norms.l1);
    norms = norm_errors(2, (double[]){0.5, HUGE_VAL}, window, volume, exact, exact);
    assert_true(isnan(norms.l1) && isnan(norms.l2) && isnan(norms.linf));
    norms = norm_errors(1, (double[]){0.5}, window, volume, (double[]){HUGE_VAL}, exact);
    assert_true(isnan(norms.linf));
    assert_true(isnan(norm_l1(2, (double[]){NAN, 1}, (double[]){4, 6}, exact)));
    assert_true(isnan(norm_l1(2, (double[]){0, 0}, (double[]){4, 6}, exact)));
    near_relative(norm_l1(3, (double[]){1, 3, 0}, (double[]){4, 6, NAN}, exact), 1.75, 1e-15);
}

static double scaled_step(const void *at, double x)
{
    return 1e-15 * step(at, x);
}

static void no_handler(const char *reason, const char *file, int line, int number)
{
    (void)reason, (void)file, (void)line, (void)number;
}

/* Bins in a window whose length is not 1; a position at its upper end is in the last one. */
TEST(bins_of_a_window)
{
    const double window[] = {-1, 3}, at = 0.3, x[] = {-1, 0.5, 1.5, 3}, volume[] = {1, 1, 1, 1};
    double means[4] = {0, 10, 20, 30};
    near_relative(norm_binned_l1(4, x, window, volume, (double[]){1, 12, 24, 38}, 4, means),
                  (1. + 2 + 4 + 8) / 4, 1e-15);
    gsl_error_handler_t *before = gsl_set_error_handler(no_handler);
    norm_bin_means(scaled_step, &at, window, 4, means); /* independent of the unit */
    assert_true(gsl_set_error_handler(before) == no_handler);
    near_relative(means[1], 1e-15 * (3 - 2 * at), 1e-9);
}
