/* SPDX-License-Identifier: GPL-3.0-or-later
 * Change points: steps are found where they are, odd nights and noise are not steps. */
#include "test.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "near.h"
#include "trend.h"

enum { NIGHTS = 30, MOST = 8 };

static void level(double *value, size_t first, size_t end, double height)
{
    for (size_t i = first; i < end; i++) value[i] = height;
}

static size_t changes_of(const double *value, struct trend_change *changes)
{
    return trend_changes(NIGHTS, value, 0.01, changes, MOST);
}

TEST(nothing_changes)
{
    double value[NIGHTS];
    struct trend_change changes[MOST];
    level(value, 0, NIGHTS, -5);
    assert_int_equal(changes_of(value, changes), 0);
    level(value, 12, NIGHTS, -4.992); /* within the noise */
    assert_int_equal(changes_of(value, changes), 0);
    assert_int_equal(trend_changes(1, value, 0.01, changes, MOST), 0);
    assert_int_equal(trend_changes(0, value, 0.01, changes, MOST), 0);
}

TEST(one_step)
{
    double value[NIGHTS];
    struct trend_change changes[MOST];
    for (size_t at = 1; at < NIGHTS; at++)
        for (double height = -4.98; height < -1; height += 0.7) {
            level(value, 0, at, -5);
            level(value, at, NIGHTS, height);
            assert_int_equal(changes_of(value, changes), 1);
            assert_int_equal(changes[0].at, at);
            near_absolute(changes[0].before, -5, 0);
            near_absolute(changes[0].after, height, 0);
        }
    assert_int_equal(trend_changes(2, (const double[]){1, 2}, 0.01, changes, MOST), 1);
}

/* One or two odd nights that are over do not count; a last night does. */
TEST(odd_nights)
{
    double value[NIGHTS];
    struct trend_change changes[MOST];
    for (size_t at = 4; at < NIGHTS - 4; at++) {
        level(value, 0, NIGHTS, 1);
        value[at] = 3;
        assert_int_equal(changes_of(value, changes), 0);
        value[at + 1] = 3;
        assert_int_equal(changes_of(value, changes), 0);
    }
    level(value, 0, NIGHTS, 1);
    value[NIGHTS - 1] = 3;
    assert_int_equal(changes_of(value, changes), 1);
    assert_int_equal(changes[0].at, NIGHTS - 1);
}

/* An odd night beside a step, on its far side and further than it jumps, does not date it. */
TEST(odd_nights_beside_a_step)
{
    static const double past[] = {0.5, 1.2, 1.5};
    double value[NIGHTS];
    struct trend_change changes[MOST];
    for (size_t at = 6; at < NIGHTS - 6; at++)
        for (size_t night = at - 4; night < at + 4; night++)
            for (size_t k = 0; k < sizeof past / sizeof *past; k++) {
                if (night == at - 1 || night == at) continue; /* it may be the step's own */
                level(value, 0, at, 1);
                level(value, at, NIGHTS, 2);
                value[night] = night < at ? 1 - past[k] : 2 + past[k];
                assert_int_equal(changes_of(value, changes), 1);
                assert_int_equal(changes[0].at, at);
                near_absolute(changes[0].before, 1, 0);
                near_absolute(changes[0].after, 2, 0);
            }
}

TEST(several_steps)
{
    double value[NIGHTS];
    struct trend_change changes[MOST];
    level(value, 0, 9, 1);
    level(value, 9, 13, 2); /* up, down again, and up a little */
    level(value, 13, 25, 1);
    level(value, 25, NIGHTS, 1.1);
    assert_int_equal(changes_of(value, changes), 3);
    assert_int_equal(changes[0].at, 9);
    assert_int_equal(changes[1].at, 13);
    assert_int_equal(changes[2].at, 25);
    assert_int_equal(trend_changes(NIGHTS, value, 0.01, changes, 2), 2);
    /* four nights at another level, and back in the last: equally near to either night before */
    for (double height = -7.01; height < -6; height += 0.0371) {
        level(value, 0, NIGHTS, -6.011);
        level(value, NIGHTS - 5, NIGHTS - 1, height);
        if (height > -6.1 && height < -5.9) continue;
        assert_int_equal(changes_of(value, changes), 2);
        assert_int_equal(changes[0].at, NIGHTS - 5);
        assert_int_equal(changes[1].at, NIGHTS - 1);
    }
}

/* Noise of 5 %: rarely taken for a step; a step of 50 % is found within a night of its place. */
TEST(noise)
{
    enum { TRIALS = 400 };
    double value[NIGHTS];
    struct trend_change changes[MOST];
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    size_t false_alarms = 0, found = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        for (size_t i = 0; i < NIGHTS; i++) value[i] = gsl_ran_gaussian(random, 0.05);
        false_alarms += trend_changes(NIGHTS, value, 0.1, changes, MOST);
        for (size_t i = 17; i < NIGHTS; i++) value[i] += 0.5;
        const size_t n = trend_changes(NIGHTS, value, 0.1, changes, MOST);
        for (size_t c = 0; c < n; c++)
            if (changes[c].at >= 16 && changes[c].at <= 18) {
                found++;
                break;
            }
    }
    gsl_rng_free(random);
    print_message("%zu false alarms, %zu of %d steps found\n", false_alarms, found, TRIALS);
    assert_true(false_alarms < TRIALS / 10);
    assert_true(found > TRIALS * 97 / 100);
}
