/* SPDX-License-Identifier: GPL-3.0-or-later
 * How many threads work, on clocks that are made up: as fast as the better choice, wherever other
 * programs come and go. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "team.h"

/* A second of steps of `pace` seconds each; more threads take `ratio` times as long as one. Returns
 * the seconds that steps took over those of the better choice. */
static double loss(struct team *team, double *now, double pace, double ratio)
{
    double taken = 0, best = 0;
    for (double end = *now + fmax(1, 400 * pace); *now < end;) {
        const double step = team->size > 1 ? pace * ratio : pace;
        *now += step;
        taken += step;
        best += pace * fmin(1, ratio);
        team_step(team, *now);
    }
    return taken / best;
}

static const double paces[] = {2e-6, 1e-4, 3e-3, 0.05, 1.5};
enum { PACES = sizeof paces / sizeof *paces };

static void stay_near_the_better_choice(void **state)
{
    (void)state;
    for (int k = 0; k < PACES; k++)
        for (int t = 2; t <= 16; t *= 2) {
            struct team team;
            double now = 7;
            team_begin(&team, t);
            assert_int_equal(team.size, t);
            assert_true(loss(&team, &now, paces[k], 1. / t) <= 1.1);
            assert_int_equal(team.size == 1 || team.size == t, 1);
            /* somebody else comes: the present stretch is lost, the next ones are not; waiting for
             * slices of time costs short steps most */
            const double ratio = paces[k] < 1e-2 ? 8 : 1.5;
            loss(&team, &now, paces[k], ratio);
            for (int again = 0; again < 3; again++)
                assert_true(loss(&team, &now, paces[k], ratio) <= 1.2);
            loss(&team, &now, paces[k], 1. / t);
            loss(&team, &now, paces[k], 1. / t);
            assert_true(loss(&team, &now, paces[k], 1. / t) <= 1.1);
        }
}

static void alone_there_is_no_choice(void **state)
{
    struct team team;
    double now = 7;
    (void)state;
    team_begin(&team, 1);
    assert_true(loss(&team, &now, 1e-3, 1) <= 1);
    assert_int_equal(team.size, 1);
}

static void pauses_count_for_nobody(void **state)
{
    struct team team;
    double now = 7;
    (void)state;
    team_begin(&team, 2);
    int together = 0;
    for (int k = 0; k < 4000; k++) {
        if (k % 3 == 0 && team.size > 1) now += 1, team_pause(&team);
        together += team.size > 1;
        now += team.size > 1 ? 1e-2 : 2e-2;
        team_step(&team, now);
    }
    assert_true(together > 3600);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stay_near_the_better_choice),
        cmocka_unit_test(alone_there_is_no_choice),
        cmocka_unit_test(pauses_count_for_nobody),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
