/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares single steps of Newton's method for smoothing lengths with CONVENTIONS eqs. 3.4, 3.10
 * and 3.11 in extended precision. */
#include "test.h"

#include "draw.h"
#include "solver.h"
#include "width.h"

typedef long double real;

static const double constants[] = {0, 1.25, 2.5, 3.75};

static struct width_rule rule_of(int dim, double tolerance)
{
    return (struct width_rule){dim, 2.2, constants[dim], tolerance};
}

/* eta (m/rho)^(1/d), rho = C_d sum/h^d. */
static real target(const struct width_rule *rule, double m, double sum, double h)
{
    const real rho = rule->constant * (real)sum / powl(h, rule->dim);
    return rule->eta * powl(m / rho, 1.0L / rule->dim);
}

TEST(widths_of_even_gas)
{
    for (int dim = 1; dim <= 3; dim++) {
        const struct width_rule rule = rule_of(dim, 1e-3);
        near_relative(width_of(&rule, 3, 7), 2.2 * pow(3. / 7, 1. / dim), 1e-15);
        static const double ball[] = {0, 2, M_PI, 4 * M_PI / 3};
        near_relative(width_neighbours(dim, 1.7), ball[dim] * pow(1.7, dim), 1e-14);
    }
}

/* The tolerance is the scheme's, and at most 1e-10 at the start. */
TEST(tolerance_of_widths)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int later = 0; later < 2; later++)
            for (int k = 0; k < 3; k++) {
                const double tolerance = k == 0 ? 1e-4 : k == 1 ? 1e-10 : 1e-12;
                struct simulation s = {.particles.dim = dim, .dt = later ? 1e-300 : 0};
                s.scheme.eta = 2.75, s.scheme.h_tolerance = tolerance;
                memcpy(s.scheme.kernel.constant, constants, sizeof constants);
                const struct width_rule rule = width_rule_of(&s);
                assert_true(rule.dim == dim && rule.eta == 2.75 && rule.constant == constants[dim]);
                assert_true(rule.tolerance == (later ? tolerance : fmin(tolerance, 1e-10)));
            }
}

enum { LEN = 11 };

struct batch {
    double m[LEN + 1], h[LEN + 1], h_inverse[LEN + 1];
    struct density_sums sums;
    struct width_bracket bracket;
};

/* Widths up to a third off their roots, and one more behind them that must not change. */
static struct batch drawn_batch(const struct width_rule *rule, double high)
{
    struct batch b;
    b.bracket.low[LEN] = b.bracket.high[LEN] = 77;
    width_begin(&b.bracket, LEN, high);
    assert_true(b.bracket.low[LEN] == 77 && b.bracket.high[LEN] == 77);
    for (int i = 0; i <= LEN; i++) {
        b.m[i] = draw(0.5, 2), b.h[i] = draw(0.5, 2);
        b.sums.m[i] = draw(0.7, 1.4) * b.m[i] * pow(rule->eta, rule->dim) / rule->constant;
        b.sums.m_dh[i] = draw(-0.3, 0.3) * b.sums.m[i];
        b.h_inverse[i] = 1 / b.h[i];
        if (i < LEN) assert_true(b.bracket.low[i] == 0 && b.bracket.high[i] == high);
    }
    return b;
}

/* A step is Newton's; the side of the bracket where the old width lies becomes the old width. */
TEST(newton_steps)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int setup = 0; setup < 50; setup++) {
            const struct width_rule rule = rule_of(dim, 1e-12);
            struct batch b = drawn_batch(&rule, setup % 2 ? INFINITY : 40);
            const struct batch old = b;
            assert_true(width_step(&rule, LEN, b.m, &b.sums, &b.bracket, b.h, b.h_inverse));
            for (int i = 0; i < LEN; i++) {
                const real asked = target(&rule, b.m[i], b.sums.m[i], old.h[i]);
                const real slope =
                    1 - asked / old.h[i] * b.sums.m_dh[i] / (dim * (real)b.sums.m[i]);
                const real next = old.h[i] - (old.h[i] - asked) / slope;
                assert_true(next > 0 && next < 2 * old.h[i]);
                near_relative(b.h[i], (double)next, 4e-15);
                assert_true(b.h_inverse[i] == 1 / b.h[i]);
                const bool wider = old.h[i] < asked;
                assert_true(b.bracket.low[i] == (wider ? old.h[i] : 0));
                assert_true(b.bracket.high[i] == (wider ? old.bracket.high[i] : old.h[i]));
            }
            assert_true(b.h[LEN] == old.h[LEN] && b.h_inverse[LEN] == old.h_inverse[LEN]);
        }
}

/* A width within the tolerance stays as it is, and so does its bracket. */
TEST(converged_widths_stay)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 4; k++) {
            const struct width_rule rule = rule_of(dim, 1e-3);
            struct batch b = drawn_batch(&rule, INFINITY);
            const double off = (k % 2 ? 1 : -1) * (k < 2 ? 0.999e-3 : 1.001e-3);
            for (int i = 0; i < LEN; i++) { /* the root is h (1 + off) */
                b.sums.m[i] = b.m[i] * pow(rule.eta / (1 + off), dim) / rule.constant;
                b.sums.m_dh[i] = 0;
            }
            const struct batch old = b;
            const bool open = width_step(&rule, LEN, b.m, &b.sums, &b.bracket, b.h, b.h_inverse);
            assert_int_equal(open, k >= 2);
            for (int i = 0; i < LEN; i++) {
                assert_int_equal(b.h[i] != old.h[i], k >= 2);
                assert_int_equal(b.bracket.low[i] > 0, k == 3);
                assert_int_equal(isinf(b.bracket.high[i]) == 0, k == 2);
            }
        }
}

/* Where Newton's step leaves the bracket or has the wrong direction: bisection, or twice the width
 * while the bracket has no upper end; a bracket of two neighbouring numbers closes. */
TEST(steps_stay_within_brackets)
{
    const struct width_rule rule = rule_of(1, 1e-12);
    const double even = rule.eta / rule.constant;  /* for m = 1, the sum whose root is h itself */
    static const double end = 0x1.0000000000001p0; /* the number after 1 */
    const struct {
        double sum, dh, h, low, high, next;
    } rows[] = {
        {0.1, 0, 1, 0, INFINITY, 2},               /* the root is 10 h, beyond 2 h */
        {0.1, 0, 1, 0, 1.5, 1.25},                 /* beyond the upper end */
        {0.9, 2, 1, 0, INFINITY, 2},               /* a derivative below 0 */
        {0.9, 2, 1, 0, 3, 2},                      /* the middle of 1 and 3 */
        {0.9, 2, 1, 0, 5, 2},                      /* the middle is 3, more than twice h */
        {10, 0, 1, 0.5, INFINITY, 0.75},           /* below the bracket */
        {1.25, -2, 1, 0, INFINITY, 1 - 0.2 / 2.6}, /* 1 - (1 - 0.8)/(1 + 0.8 * 2) */
        {0.9, 0, 1, 0, end, end},                  /* no number lies between 1 and end */
    };
    enum { ROWS = sizeof rows / sizeof *rows };
    double m[ROWS], h[ROWS], h_inverse[ROWS];
    struct density_sums sums;
    struct width_bracket bracket;
    for (int k = 0; k < ROWS; k++) { /* all rows in one call, with 1.5 times the widths */
        m[k] = 1, h[k] = 1.5 * rows[k].h, h_inverse[k] = 1 / h[k];
        sums.m[k] = rows[k].sum * even, sums.m_dh[k] = rows[k].dh * sums.m[k];
        bracket.low[k] = 1.5 * rows[k].low;
        bracket.high[k] = rows[k].high == end ? nextafter(1.5, 2) : 1.5 * rows[k].high;
    }
    assert_true(width_step(&rule, ROWS, m, &sums, &bracket, h, h_inverse));
    for (int k = 0; k < ROWS; k++) {
        near_relative(h[k], 1.5 * rows[k].next, 1e-15);
        near_relative(h_inverse[k], 1 / (1.5 * rows[k].next), 1e-15);
        assert_int_equal(bracket.low[k] == bracket.high[k], rows[k].high == end);
    }
}

/* The first particle that is off by more than a millionth. */
TEST(first_particle_without_a_root)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int first = 0; first <= LEN; first++)
            for (int k = 0; k < 5; k++) {
                const struct width_rule rule = rule_of(dim, 1e-3);
                struct batch b = drawn_batch(&rule, INFINITY);
                for (int i = 0; i < LEN; i++) {
                    const double off = i < first || i % 2 == 0 ? 0.999e-6 : -0.999e-6;
                    b.sums.m[i] = b.m[i] * pow(rule.eta / (1 + off), dim) / rule.constant;
                }
                static const double bad[] = {1.001e-6, -1.001e-6, 0.5, -0.5, NAN};
                for (int i = first; i < LEN; i += 2)
                    b.sums.m[i] = b.m[i] * pow(rule.eta / (1 + bad[k]), dim) / rule.constant;
                assert_int_equal(width_without_root(&rule, LEN, b.m, &b.sums, b.h, b.h_inverse),
                                 first < LEN ? first : -1);
            }
}

/* 1/h is extrapolated linearly, but grows by at most a quarter and falls by at most a fifth. */
TEST(predicted_widths)
{
    for (int len = BATCH_MAX - 1; len <= BATCH_MAX; len++) {
        struct particles a;
        struct error error;
        double found[BATCH_MAX], last[BATCH_MAX];
        if (particles_create(&a, 2, BATCH_MAX + 9, 0, &error)) fail_msg("%s", error.message);
        for (int i = 0; i < BATCH_MAX + 9; i++)
            a.h_inverse[i] = 5, a.h_inverse_found[i] = 6, a.h_inverse_old[i] = 7;
        for (int i = 0; i < len; i++) {
            found[i] = a.h_inverse_found[4 + i] = draw(0.5, 2);
            last[i] = a.h_inverse_old[4 + i] = found[i] * (1 + draw(-0.45, 0.45));
        }
        width_predict(&a, 4, len, 0.875);
        int bound = 0;
        for (int i = 0; i < len; i++) {
            const real next = found[i] + 0.875L * ((real)found[i] - last[i]);
            const double held = fmax(0.8 * found[i], fmin(1.25 * found[i], (double)next));
            near_relative(a.h_inverse[4 + i], held, 4e-16);
            assert_true(a.h_inverse_old[4 + i] == found[i]);
            bound += next < 0.8 * found[i] ? 1 : next > 1.25 * found[i] ? 100 : 0;
        }
        assert_true(bound % 100 > 3 && bound / 100 > 1);
        for (int i = 0; i < BATCH_MAX + 9; i++)
            if (i < 4 || i >= 4 + len) assert_true(a.h_inverse[i] == 5 && a.h_inverse_old[i] == 7);
        particles_destroy(&a);
    }
}
