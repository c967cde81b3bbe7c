/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the comparison of paired errors, and its rate of false differences. */
#include "test.h"

#include "paired.h"

/* By hand: ratios 0.8, 0.9, 1.0 with t(0.975, 2) = 4.302653; five with t(0.975, 4) = 2.776445. */
TEST(intervals_by_hand)
{
    static const struct {
        size_t n;
        double a[5], b[5], t;
        bool single;
        size_t counts;
        enum paired_verdict verdict;
    } rows[] = {
        {3, {1, 2, 4}, {0.8, 1.8, 4}, 4.3026527, false, 3, PAIRED_NONE},
        {3, {1, 2, 4}, {0.8, 1.62, 3.28}, 4.3026527, false, 3, PAIRED_BETTER},
        {3, {0.8, 1.62, 3.28}, {1, 2, 4}, 4.3026527, false, 3, PAIRED_WORSE},
        {5, {1, 1, 1, 1, 1}, {1.2, 1.3, 1.25, 1.22, 1.28}, 2.7764451, false, 5, PAIRED_WORSE},
        {5, {1, 1, 1, 1, 1}, {1.2, 1.3, 1.25, 1.22, 1.28}, 2.7764451, true, 5, PAIRED_WORSE},
        {5, {1, 1, 1, 1, 1}, {1.0, 1.3, 1.1, 1.2, 1.15}, 2.7764451, false, 5, PAIRED_WORSE},
        {5, {1, 1, 1, 1, 1}, {1.0, 1.3, 1.1, 1.2, 1.15}, 2.7764451, true, 5, PAIRED_NONE},
        {5, {1, 0, NAN, 2, 1}, {1.2, 1, 1, INFINITY, 1.21}, 12.706205, false, 2, PAIRED_WORSE},
        {3, {1, 2, 3}, {1.0009, 2.0018, 3.0027}, 4.3026527, false, 3, PAIRED_NONE},
        {3, {1, 2, 3}, {1.0011, 2.0022, 3.0033}, 4.3026527, false, 3, PAIRED_WORSE},
        {1, {1}, {0.5}, NAN, false, 1, PAIRED_UNKNOWN},
        {1, {1}, {1}, NAN, false, 1, PAIRED_NONE},
        {5, {1, 2, 3, 4, 5}, {1, 2, 3, 4, 5}, 2.7764451, false, 5, PAIRED_NONE},
        {0, {0}, {0}, NAN, false, 0, PAIRED_NONE},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct paired got =
            paired_compare(rows[k].n, rows[k].a, rows[k].b, rows[k].single, 0.05);
        double mean = 0, squares = 0, count = 0;
        for (size_t i = 0; i < rows[k].n; i++) {
            const double ratio = log(rows[k].b[i] / rows[k].a[i]);
            if (isfinite(ratio)) mean += ratio, squares += ratio * ratio, count++;
        }
        assert_int_equal(got.n, rows[k].counts);
        if (got.verdict != rows[k].verdict)
            fail_msg("row %zu: %s: %g +- %g", k, paired_verdicts[got.verdict], got.change,
                     got.half);
        if (!got.n) {
            assert_true(isnan(got.a) && isnan(got.change));
            continue;
        }
        mean /= count;
        near_absolute(got.change, exp(mean) - 1, 1e-14);
        near_relative(got.b / got.a, exp(mean), 1e-13);
        if (got.n < 2) {
            assert_true(isnan(got.half));
            continue;
        }
        const double variance = fmax(0, squares - count * mean * mean) / (count - 1);
        near_absolute(got.half,
                      exp(mean) * rows[k].t * sqrt(variance * (1 / count + rows[k].single)), 2e-7);
    }
}

static double normal(void)
{
    static uint64_t seed = 2385;
    double sum = -6;
    for (int k = 0; k < 12; k++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        sum += (double)(seed >> 33) * 0x1p-31;
    }
    return sum;
}

/* For equal sides a share `level` of the verdicts is a difference, also if one side is a single
 * draw; exchanging the sides inverts every verdict. */
TEST(rate_of_false_differences)
{
    enum { TIMES = 4000, DRAWS = 5 };
    for (int single = 0; single < 2; single++) {
        int said = 0;
        for (int k = 0; k < TIMES; k++) {
            double a[DRAWS], b[DRAWS];
            const double common = 0.1 * normal();
            for (int i = 0; i < DRAWS; i++) {
                a[i] = exp(single ? common : 0.1 * normal());
                b[i] = exp(single ? 0.1 * normal() : 0.1 * normal());
            }
            const struct paired ab = paired_compare(DRAWS, a, b, single, 0.05),
                                ba = paired_compare(DRAWS, b, a, single, 0.05);
            said += ab.verdict != PAIRED_NONE;
            assert_true((ab.verdict == PAIRED_BETTER) == (ba.verdict == PAIRED_WORSE) &&
                        (ab.verdict == PAIRED_WORSE) == (ba.verdict == PAIRED_BETTER));
            near_relative((1 + ab.change) * (1 + ba.change), 1, 1e-12);
        }
        near_inside((double)said / TIMES, 0.035, 0.065);
    }
}
