/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the status of a figure, its ratio to the bound, and whether its value or its floor fails.
 */
#include "test.h"

#include <stdbool.h>

#include "finding.h"

TEST(words_of_statuses)
{
    static const char *const words[] = {"none",  "pass",         "fail", "known",
                                        "smoke", "undetermined", "skip"};
    for (int s = FINDING_NONE; s <= FINDING_SKIP; s++)
        assert_string_equal(finding_words[s], words[s]);
    assert_null(finding_words[FINDING_SKIP + 1]);
    assert_string_equal(finding_words[FINDING_PASS], "pass");
    assert_string_equal(finding_words[FINDING_UNDETERMINED], "undetermined");
}

TEST(ratios)
{
    assert_true(finding_ratio(0, 0) == 0 && finding_ratio(-1, 0) == 0 &&
                finding_ratio(-1, -1) == 0);
    assert_true(finding_ratio(1e-7, 1) == 1e-7 && finding_ratio(2, 2) == 1 &&
                finding_ratio(3, 2) == 1.5);
    assert_true(isinf(finding_ratio(1, 0)) && isinf(finding_ratio(0, -1)) &&
                isinf(finding_ratio((double)NAN, 1)));
}

/* A number from a short list, so that bounds are met exactly. */
static double drawn(void)
{
    static const double values[] = {0, 0.5, 1, 2, 3, -1, (double)NAN, (double)INFINITY};
    return values[rand() % (int)(sizeof values / sizeof *values)];
}

/* The value fails, or the floor if the value alone would pass; the failing one is beyond the
 * bound. */
TEST(what_fails)
{
    size_t seen[2][2] = {{0}};
    srand(5);
    for (int k = 0; k < 2000; k++) {
        struct finding of = {.value = drawn(), .bound = drawn(), .floor = drawn()};
        if (isinf(of.bound)) of.bound = 1;
        const bool well = of.value <= of.bound, quiet = of.floor <= of.bound;
        double beyond;
        const enum finding_status status = finding_judge(of.value, of.bound, of.floor);
        const double excess = finding_excess(&of, &beyond);
        assert_int_equal(status, well && quiet ? FINDING_PASS : FINDING_FAIL);
        seen[well][quiet]++;
        const double fails = well && of.floor > of.bound ? of.floor : of.value;
        assert_memory_equal(&beyond, &fails, sizeof beyond);
        if (!well || of.floor > of.bound) assert_true(excess > 1);
        if (status == FINDING_PASS) assert_true(excess <= 1);
    }
    for (int k = 0; k < 4; k++) assert_true(seen[k / 2][k % 2] > 100);
}
