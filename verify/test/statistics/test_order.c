/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests orders, their intervals, classes and gates, and Richardson extrapolation at their limits.
 * (The checks `norms` test them in general.) */
#include "test.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_errno.h>

#include "order.h"

/* The 97.5 % point of Student's t for two degrees of freedom, in closed form. */
static double t_975_2(void)
{
    return 0.95 * sqrt(2 / (1 - 0.95 * 0.95));
}

/* y = 2 + x with residuals +-e in a pattern orthogonal to the line: slope, interval by hand. */
TEST(order_interval)
{
    const double e = 0.02;
    const double spacing[] = {exp(3), exp(2), exp(1), 1};
    const double error[] = {exp(5 + e), exp(4 - e), exp(3 - e), exp(2 + e)};
    struct order_fit fit;
    assert_int_equal(order_fit(4, spacing, error, NULL, &fit, NULL), STATUS_OK);
    near_relative(fit.order, 1, 1e-14);
    /* s^2 = 4 e^2/2, Sxx = 5, t(0.975, 2) in closed form */
    near_relative((fit.high - fit.low) / 2, t_975_2() * sqrt(2 * e * e / 5), 1e-12);
    near_relative(fit.pairwise[0], 1 + 2 * e, 1e-12);
    near_relative(fit.finest, exp(2 + e), 1e-15);
    assert_int_equal(fit.class, ORDER_ASYMPTOTIC);

    /* Replicates that differ by more than the scatter: s^2/Sxx, Satterthwaite's degrees of freedom
     * from c_i^2 = (0.3, 0.1, 0.1, 0.3)^2: (0.2)^2 8/(2 0.3^4 + 2 0.1^4). If they differ by less,
     * the scatter is used, because they cannot explain it. */
    const double noisy[] = {0.01, 0.01, 0.01, 0.01}, quiet[] = {1e-9, 1e-9, 1e-9, 1e-9};
    const struct order_noise loud = {noisy, 9}, faint = {quiet, 9};
    const double freedom = 0.04 * 8 / (2 * 0.0081 + 2 * 0.0001);
    struct order_fit replicated;
    assert_int_equal(order_fit(4, spacing, error, &loud, &replicated, NULL), STATUS_OK);
    near_relative((replicated.high - replicated.low) / 2,
                  gsl_cdf_tdist_Pinv(0.975, freedom) * sqrt(0.01 / 5), 1e-12);
    assert_int_equal(order_fit(4, spacing, error, &faint, &replicated, NULL), STATUS_OK);
    near_relative(replicated.high - replicated.low, fit.high - fit.low, 1e-9);
    /* only as many levels are used as there are variances */
    const double behind[] = {0.01, 0.01, 0.01, 0.01, NAN};
    assert_int_equal(
        order_fit(4, spacing, error, &(struct order_noise){behind, 9}, &replicated, NULL),
        STATUS_OK);
    near_relative((replicated.high - replicated.low) / 2,
                  gsl_cdf_tdist_Pinv(0.975, freedom) * sqrt(0.01 / 5), 1e-12);
    /* equal replicates: no noise to weigh by */
    const double none[4] = {0};
    assert_int_equal(
        order_fit(4, spacing, error, &(struct order_noise){none, 9}, &replicated, NULL), STATUS_OK);
    near_relative(replicated.high - replicated.low, fit.high - fit.low, 1e-12);
}

TEST(order_bad_levels)
{
    struct order_fit fit;
    struct error failure;
    const double spacing[] = {4, 2, 2, 1}, error[] = {4, 2, 2, 1};
    assert_int_equal(order_fit(3, spacing, error, NULL, &fit, &failure), STATUS_BAD_INPUT);
    assert_non_null(strstr(failure.message, "4"));
    assert_int_equal(order_fit(4, spacing, error, NULL, &fit, &failure), STATUS_BAD_INPUT);
    assert_non_null(strstr(failure.message, "distinct"));
}

TEST(gates_of_orders)
{
    char why[ORDER_GATE_TEXT];
    const struct order_gate gate = {0.9, 1.1, 1e-3};
    struct order_fit fit = {.order = 1, .low = 0.9, .high = 1.1, .n = 4, .finest = 1e-3};
    assert_true(order_passes(&fit, &gate, why) && !why[0]);
    fit.finest = 1.01e-3;
    assert_true(!order_passes(&fit, &gate, why) && strstr(why, "finest"));
    fit.finest = NAN;
    assert_false(order_passes(&fit, &gate, why));
    fit.finest = 1e-4, fit.low = 0.8, fit.high = 1.2;
    assert_true(!order_passes(&fit, &gate, why) && strstr(why, "0.2"));
    fit.low = fit.high = NAN;
    assert_false(order_passes(&fit, &gate, why));
    fit.low = fit.high = fit.order = 1.11;
    assert_true(!order_passes(&fit, &gate, why) && strstr(why, "outside"));
    fit.low = fit.high = fit.order = NAN;
    assert_false(order_passes(&fit, &gate, NULL));
}

static enum order_class class_of(const double *error)
{
    const double spacing[] = {1, 0.5, 0.25, 0.125, 0.0625};
    struct order_fit fit;
    assert_int_equal(order_fit(5, spacing, error, NULL, &fit, NULL), STATUS_OK);
    return fit.class;
}

TEST(richardson_unequal_ratios)
{
    const double spacing[] = {0.1, 0.06, 0.025}, p = 1.37;
    double value[3];
    for (int i = 0; i < 3; i++) value[i] = 2.385 - 0.7 * pow(spacing[i], p);
    const struct order_extrapolation e = order_extrapolate(spacing, value, NAN);
    near_relative(e.order, p, 1e-11);
    /* the root of the defining equation, to the last digits */
    const double fine = log(0.06 / 0.025), coarse = log(0.1 / 0.06),
                 change = (value[1] - value[0]) / (value[2] - value[1]);
    near_relative(exp(fine * e.order) * expm1(coarse * e.order) / expm1(fine * e.order), change,
                  1e-14);
}

/* The largest number of levels; pairwise orders are those between levels and no more. */
TEST(order_capacity)
{
    double spacing[ORDER_LEVELS_MAX + 1], error[ORDER_LEVELS_MAX + 1];
    struct order_fit fit;
    struct error failure;
    for (int i = 0; i <= ORDER_LEVELS_MAX; i++) {
        spacing[i] = pow(0.9, i);
        error[i] = spacing[i] * spacing[i];
    }
    assert_int_equal(order_fit(ORDER_LEVELS_MAX, spacing, error, NULL, &fit, &failure), STATUS_OK);
    near_relative(fit.order, 2, 1e-12);
    assert_int_equal(order_fit(ORDER_LEVELS_MAX + 1, spacing, error, NULL, &fit, &failure),
                     STATUS_BAD_INPUT);
    assert_int_equal(order_fit(5, spacing, error, NULL, &fit, &failure), STATUS_OK);
    for (int i = 0; i < 4; i++) near_relative(fit.pairwise[i], 2, 1e-12);
    for (int i = 4; i < ORDER_LEVELS_MAX - 1; i++) assert_true(fit.pairwise[i] == 0);
}

/* Errors that grow once, at any level, do not fall from level to level. */
TEST(one_rise)
{
    const double spacing[] = {1, 0.5, 0.25, 0.125, 0.0625, 0.03125};
    for (int rise = 1; rise < 5; rise++) {
        double error[6] = {1};
        for (int i = 1; i < 6; i++) error[i] = error[i - 1] * (i == rise ? 1.25 : 0.5);
        struct order_fit fit;
        struct error failure;
        assert_int_equal(order_fit(6, spacing, error, NULL, &fit, &failure), STATUS_OK);
        assert_int_equal(fit.class, ORDER_OSCILLATING);
    }
}

/* Levels deviate from their line by as much as replicates explain at 1 % (an F test), or by just
 * more: then the scatter is used. */
TEST(order_curvature)
{
    const double e = 0.02, limit = gsl_cdf_fdist_Qinv(0.01, 2, 4 * 8);
    const double spacing[] = {exp(3), exp(2), exp(1), 1};
    const double error[] = {exp(5 + e), exp(4 - e), exp(3 - e), exp(2 + e)};
    for (int more = 0; more < 2; more++) {
        /* chi^2/2 = 4 e^2/(2 s^2) */
        const double s2 = 2 * e * e / (limit * (more ? 1 + 5e-8 : 1 - 5e-8));
        const double variance[] = {s2, s2, s2, s2};
        struct order_fit fit;
        assert_int_equal(
            order_fit(4, spacing, error, &(struct order_noise){variance, 9}, &fit, NULL),
            STATUS_OK);
        const double freedom = 0.04 * 8 / (2 * 0.0081 + 2 * 0.0001);
        near_relative((fit.high - fit.low) / 2,
                      more ? t_975_2() * sqrt(2 * e * e / 5)
                           : gsl_cdf_tdist_Pinv(0.975, freedom) * sqrt(s2 / 5),
                      1e-9);
    }
}

/* Noise that differs from level to level: weights, slope and interval by hand. The weights shrink
 * the variance of each level, which has 4 degrees of freedom, towards the mean of all, which counts
 * as 24 degrees of freedom. */
TEST(order_weights)
{
    const double x[] = {3, 2, 1, 0}, y[] = {3.3, 2.1, 0.7, 0.2};
    const double variance[] = {0.04, 0.01, 0.09, 0.02};
    double spacing[4], error[4], w[4], sum = 0, xbar = 0, ybar = 0, xx = 0, xy = 0;
    double total = 0, parts = 0;
    for (int i = 0; i < 4; i++) {
        spacing[i] = exp(x[i]);
        error[i] = exp(y[i]);
        w[i] = 28 / (4 * variance[i] + 24 * 0.04);
        sum += w[i];
    }
    for (int i = 0; i < 4; i++) xbar += w[i] * x[i] / sum, ybar += w[i] * y[i] / sum;
    for (int i = 0; i < 4; i++) {
        xx += w[i] * (x[i] - xbar) * (x[i] - xbar);
        xy += w[i] * (x[i] - xbar) * (y[i] - ybar);
    }
    for (int i = 0; i < 4; i++) {
        const double part = pow(w[i] * (x[i] - xbar) / xx, 2) * variance[i];
        total += part;
        parts += part * part / 4;
    }
    struct order_fit fit;
    assert_int_equal(order_fit(4, spacing, error, &(struct order_noise){variance, 5}, &fit, NULL),
                     STATUS_OK);
    near_relative(fit.order, xy / xx, 1e-12);
    near_relative((fit.high - fit.low) / 2,
                  gsl_cdf_tdist_Pinv(0.975, total * total / parts) * sqrt(total), 1e-12);
}

/* Errors that fall by less than a tenth of an order over all levels are flat; there is a floor if
 * the last order is below a third of the best one, at any level. */
TEST(class_limits)
{
    static const struct {
        double order[4];
        enum order_class class;
    } cases[] = {
        {{0.099, 0.099, 0.099, 0.099}, ORDER_FLOOR_LIMITED},
        {{0.101, 0.101, 0.101, 0.101}, ORDER_ASYMPTOTIC},
        {{-0.099, -0.099, -0.099, -0.099}, ORDER_FLOOR_LIMITED},
        {{-0.101, -0.101, -0.101, -0.101}, ORDER_DIVERGING},
        {{0.5, 0.5, 2, 0.66}, ORDER_FLOOR_LIMITED},
        {{0.5, 2, 0.5, 0.66}, ORDER_FLOOR_LIMITED},
        {{2, 0.5, 0.5, 0.66}, ORDER_FLOOR_LIMITED},
        {{0.5, 2, 0.5, 0.67}, ORDER_ASYMPTOTIC},
        {{-0.5, 2, 0.5, 0.66}, ORDER_OSCILLATING},
        {{0.5, 2, -0.5, 0.66}, ORDER_FLOOR_LIMITED},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double error[5] = {1};
        for (int l = 1; l < 5; l++) error[l] = error[l - 1] / pow(2, cases[i].order[l - 1]);
        if (class_of(error) != cases[i].class)
            fail_msg("case %zu: %s", i, order_class_name(class_of(error)));
    }
}

/* Orders are searched from 1e-3 to 30; the caller's error handler of GSL is restored. */
static void own_handler(const char *reason, const char *file, int line, int code)
{
    fail_msg("%s:%d: %s (%d)", file, line, reason, code);
}

TEST(richardson_range)
{
    gsl_error_handler_t *before = gsl_set_error_handler(own_handler);
    const double orders[] = {2e-3, 0.009, 0.5, 4, 29.9999}, spacing[] = {4, 2, 1};
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        const double p = orders[i], value[] = {pow(4, p), pow(2, p), 1};
        const struct order_extrapolation e = order_extrapolate(spacing, value, NAN);
        assert_int_equal(e.class, ORDER_ASYMPTOTIC);
        near_relative(e.order, p, 1e-9);
        near_relative(e.gci_fine, 1.25, 1e-9); /* the error is the value itself */
        near_relative(e.gci_coarse, 1.25, 1e-9);
    }
    const double beyond[] = {9e-4, -1, 30 * (1 + 5e-7)};
    for (size_t i = 0; i < 3; i++) {
        const double p = beyond[i], value[] = {pow(4, p), pow(2, p), 1};
        assert_int_equal(order_extrapolate(spacing, value, NAN).class, ORDER_DIVERGING);
    }
    assert_true(gsl_set_error_handler(before) == own_handler);
}

/* Values with a known limit: it must lie within the GCI of the finest, or the errors decide. */
TEST(richardson_exact)
{
    static const struct {
        double value[3], exact;
        enum order_class class;
    } cases[] = {
        /* 1 + 0.1 h: the finest is 1.1, its GCI 0.125 */
        {{1.4, 1.2, 1.1}, 1, ORDER_ASYMPTOTIC},
        {{1.4, 1.2, 1.1}, 0.976, ORDER_ASYMPTOTIC},
        {{1.4, 1.2, 1.1}, 0.974, ORDER_PREASYMPTOTIC},
        /* within the GCI, but on the other side: errors 0.176, 0.024, 0.124; 0.11, 0.09, 0.19 */
        {{1.4, 1.2, 1.1}, 1.224, ORDER_OSCILLATING},
        {{1.4, 1.2, 1.1}, 1.29, ORDER_DIVERGING},
        /* within a GCI of four times the value, with errors that grow from level to level */
        {{0.000933, 0.001573, 0.002578}, 0, ORDER_DIVERGING},
        /* errors fall with a third of the expected order, or with less */
        {{1.4, 1.2, 1.1}, 0.716, ORDER_PREASYMPTOTIC},
        {{1.4, 1.2, 1.1}, 0.714, ORDER_FLOOR_LIMITED},
        {{-1.4, -1.2, -1.1}, -0.714, ORDER_FLOOR_LIMITED},
        /* differences grow: no order is expected; two errors fall by 4^0.099 and 4^0.101 */
        {{1, 1.1, 1.3}, 1.5, ORDER_PREASYMPTOTIC},
        {{1, 1.1, 1.3}, 0.9, ORDER_DIVERGING},
        {{1, 1.1, 1.3}, 1.2, ORDER_DIVERGING},
        {{1.1471, 1.1, 1}, 0, ORDER_FLOOR_LIMITED},
        {{1.1503, 1.1, 1}, 0, ORDER_PREASYMPTOTIC},
        {{1.01, 1.1503, 1}, 0, ORDER_OSCILLATING},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct order_extrapolation e =
            order_extrapolate((double[]){4, 2, 1}, cases[i].value, cases[i].exact);
        if (e.class != cases[i].class) fail_msg("case %zu: %s", i, order_class_name(e.class));
    }
}

/* The names of the classes, and the limits between them. */
TEST(class_words)
{
    static const char *const words[] = {"asymptotic", "floor-limited", "pre-asymptotic",
                                        "oscillating", "diverging"};
    for (int k = ORDER_ASYMPTOTIC; k <= ORDER_DIVERGING; k++)
        assert_string_equal(order_class_name((enum order_class)k), words[k]);
    assert_int_equal(class_of((double[]){16, 8, 8, 4, 2}), ORDER_OSCILLATING);
    assert_int_equal(class_of((double[]){16, 8, 8, 4, 3.9}), ORDER_OSCILLATING);
    for (int more = 0; more < 2; more++) /* a third of the best order, but for 5e-7 of it */
        assert_int_equal(class_of((double[]){512, 64, 8, 1, exp2(-1 - (more - 0.5) * 1e-6)}),
                         more ? ORDER_ASYMPTOTIC : ORDER_FLOOR_LIMITED);
    struct order_fit fit;
    assert_true(log(3) / log(59049) == ORDER_FLAT); /* equal to the limit: no floor */
    assert_int_equal(order_fit(4, (double[]){59049, 2187, 27, 1},
                               (double[]){3, pow(3, 0.7), pow(3, 0.3), 1}, NULL, &fit, NULL),
                     STATUS_OK);
    assert_int_equal(fit.class, ORDER_ASYMPTOTIC);
    struct error failure;
    assert_int_equal(
        order_fit(4, (double[]){3, 2, 1, 0}, (double[]){8, 4, 2, 1}, NULL, &fit, &failure),
        STATUS_BAD_INPUT);
    assert_int_equal(
        order_fit(4, (double[]){4, 2.5, 2.5, 1}, (double[]){8, 4, 2, 1}, NULL, &fit, &failure),
        STATUS_BAD_INPUT);
    assert_non_null(strstr(failure.message, "spacing 2 is 2.5"));
}

/* Three values that converge to a value other than the exact one, 1, from above or below, by their
 * errors; and values that reach it but for round-off. */
TEST(richardson_against_exact)
{
    const double spacing[] = {0.4, 0.2, 0.1}, wider[] = {2, 1, 0.5};
    const double third = exp2(1. / 3 * (1 - 5e-7)), more = exp2(1. / 3 * (1 + 5e-7));
    const struct {
        double error[3];
        enum order_class class;
    } cases[] = {
        {{10, 5, 3}, ORDER_PREASYMPTOTIC},
        {{3.232, 3.11, 3}, ORDER_FLOOR_LIMITED},
        {{third + 2 * (third - 1), third, 1}, ORDER_FLOOR_LIMITED},
        {{more + 2 * (more - 1), more, 1}, ORDER_PREASYMPTOTIC},
        {{-2, -1, 1}, ORDER_DIVERGING}, /* no order, and the error is as large as before */
        {{-8, -5, -1}, ORDER_PREASYMPTOTIC},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double *e = cases[k].error;
            const struct order_extrapolation found =
                order_extrapolate(sign < 0 ? spacing : wider,
                                  (double[]){1 + sign * e[0], 1 + sign * e[1], 1 + sign * e[2]}, 1);
            if (found.class != cases[k].class)
                fail_msg("case %zu, sign %d: %s", k, sign, order_class_name(found.class));
        }
    for (double p = 0.3; p < 4; p += 0.003) {
        double value[3];
        for (int i = 0; i < 3; i++) value[i] = 1 + pow(spacing[i], p);
        const struct order_extrapolation found = order_extrapolate(spacing, value, NAN);
        near_relative(found.order, p, 1e-11);
    }
    struct order_extrapolation e = order_extrapolate(spacing, (double[]){0, 0, 0}, NAN);
    assert_int_equal(e.class, ORDER_FLOOR_LIMITED);
    e = order_extrapolate(spacing, (double[]){1000 + 16e-11, 1000 + 4e-11, 1000}, NAN);
    assert_int_equal(e.class, ORDER_ASYMPTOTIC);
    e = order_extrapolate(spacing, (double[]){1000 + 8e-11, 1000 + 4e-11, 1000}, NAN);
    assert_int_equal(e.class, ORDER_FLOOR_LIMITED);
    e = order_extrapolate(spacing, (double[]){1000 + 1.3e-9, 1000 + 5e-10, 1000}, NAN);
    assert_int_equal(e.class, ORDER_ASYMPTOTIC);
    e = order_extrapolate(spacing, (double[]){1 + 3e-12, 1 + 1e-12, 1}, 1 - 1.3e-12);
    assert_int_equal(e.class, ORDER_ASYMPTOTIC); /* 1.25e-12, and 1e-13 */
}
