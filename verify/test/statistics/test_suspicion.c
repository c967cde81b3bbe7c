/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests which errors are suspected to come from wrong comparisons. */
#include "test.h"

#include "suspicion.h"

/* A field is suspected to be another one if its distance from that field's exact values is less
 * than half of their mean deviation; a distance of exactly half is allowed. */
TEST(limit_of_swapped)
{
    static const char *const names[] = {"one", "two"};
    static const double volumes[] = {1, 0.5, 1e-9}, far[] = {100, 100}, own[] = {1, 3};
    for (size_t k = 0; k < 3; k++)
        for (int nearer = 0; nearer < 2; nearer++) {
            const double volume[] = {volumes[k], volumes[k]}, value[] = {nearer ? 1.9 : 2, 3};
            char why[SUSPICION_TEXT] = "";
            assert_int_equal(suspicion_swapped(2, names, 2, volume,
                                               (const double *const[]){value, own},
                                               (const double *const[]){far, own}, why),
                             nearer);
        }
}

/* Messages name the suspicion, and elements after the last one are not read. */
TEST(suspicions)
{
    char why[SUSPICION_TEXT];
    assert_false(suspicion_zero(2, (double[]){2, 1, 0}, why));
    assert_true(suspicion_zero(2, (double[]){2, 0, 1}, why) && strstr(why, "level 1 is"));
    assert_false(suspicion_repeated(2, (double[]){2, 1, 1}, why));
    assert_false(suspicion_repeated(2, (double[]){1, 1 + 3e-12, 1e9}, why));
    assert_true(suspicion_repeated(2, (double[]){1, 1 + 5e-13, 1e-9}, why));
    assert_true(suspicion_repeated(3, (double[]){1, 4, 4, 7}, why));
    assert_string_equal(why, "levels 1 and 2 have the same error 4: was one not run?");
    assert_false(suspicion_idle_setting("eta", 2, (double[]){1, 2}, (double[]){3, 2}, why));
    assert_true(suspicion_idle_setting("eta", 2, (double[]){1, 2, 3}, (double[]){1, 2, 4}, why));
    assert_true(suspicion_idle_setting("eta", 1, (double[]){1}, (double[]){1}, why));
    assert_string_equal(why, "changing eta changed nothing: is it read at all?");

    const char *const names[] = {"u", "v", "w"};
    const double volume[] = {1, 2, 100};
    /* values and exact values of two fields, and whether the second is suspected to be the first */
    static const struct {
        double value[2][3], exact[2][3];
        bool suspected;
    } cases[] = {
        {{{0, 9}, {1, 9}}, {{0, 9}, {3.000002, 9}}, true},
        {{{0, 9}, {1, 9}}, {{0, 9}, {2.999998, 9}}, false},
        {{{0, 1e-7}, {1e-8, 1e-7}}, {{0, 1e-7}, {1e-7, 1e-7}}, true},
        {{{0, 0}, {1e-8, 0}}, {{0, 0}, {1e-7, 0}}, false}, /* near a constant does not count */
        {{{0.9, 9, 5}, {1, 9, 5}}, {{0.9, 9, 7}, {2, 9, 5}}, true},
        {{{1, 0, 5}, {1, 9, 7}}, {{1, 0, 7}, {2, 9, 5}}, false},
        {{{0, 2.5, 5}, {4, 2.5, 7}}, {{0, 2.5, 5}, {4, 0, 5}}, false},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const double *const value[] = {cases[k].value[0], cases[k].value[1]};
        const double *const exact[] = {cases[k].exact[0], cases[k].exact[1]};
        if (suspicion_swapped(2, names, 2, volume, value, exact, why) != cases[k].suspected)
            fail_msg("case %zu: %s", k, why);
    }
    const double one[] = {1, 5}, two[] = {2, 5}, far[] = {9, 5};
    const double *const value[] = {one, two}, *const exact[] = {one, far};
    assert_false(suspicion_swapped(2, names, 1, volume, value, exact, why));
    assert_true(suspicion_swapped(2, names, 2, volume, value, exact, why));
    assert_string_equal(why, "v is nearer the exact u than its own exact solution");
}
