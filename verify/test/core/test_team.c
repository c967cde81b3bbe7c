/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the choice of the number of threads, on simulated clocks: it is as fast as the better
 * choice, whenever other programs start and end. */
#include "test.h"

#include "team.h"

/* Simulates a second of steps of `pace` seconds each; with several threads a step takes `ratio`
 * times as long as with one. Returns the time taken over that of the better choice. */
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

TEST(number_of_threads_is_near_the_best)
{
    for (int k = 0; k < PACES; k++)
        for (int t = 2; t <= 16; t *= 2) {
            struct team team;
            double now = 7;
            team_begin(&team, t);
            assert_int_equal(team.size, t);
            assert_true(loss(&team, &now, paces[k], 1. / t) <= 1.1);
            assert_int_equal(team.size == 1 || team.size == t, 1);
            /* another program starts: the present stretch of steps is slow, the next ones are not;
             * short steps suffer most from waiting for a time slice */
            const double ratio = paces[k] < 1e-2 ? 8 : 1.5;
            loss(&team, &now, paces[k], ratio);
            for (int again = 0; again < 3; again++)
                assert_true(loss(&team, &now, paces[k], ratio) <= 1.2);
            loss(&team, &now, paces[k], 1. / t);
            loss(&team, &now, paces[k], 1. / t);
            assert_true(loss(&team, &now, paces[k], 1. / t) <= 1.1);
        }
}

TEST(one_thread_has_no_trials)
{
    struct team team;
    double now = 7;
    team_begin(&team, 1);
    assert_true(loss(&team, &now, 1e-3, 1) <= 1);
    assert_int_equal(team.size, 1);
}

TEST(pauses_do_not_count)
{
    struct team team;
    double now = 7;
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

/* Steps of this pace until the number of threads or the purpose changes. Returns how many. */
static int stretch(struct team *team, double *now, double step)
{
    const struct team before = *team;
    int steps = 0;
    do {
        assert_true(team->stretch == before.stretch);
        *now += step;
        team_step(team, *now);
        steps++;
        assert_int_equal(team->steps, team->begun == *now ? 0 : steps);
    } while (team->size == before.size && team->trying == before.trying);
    assert_true(team->begun == *now);
    near_relative(team->pace[before.size > 1], step, 1e-8);
    return steps;
}

/* Trials last 4 ms; between them there are stretches of 16 to 256 times that, in time and in steps,
 * twice as long each time that nothing has changed; the choice changes only if that saves 5 %. */
TEST(lengths_of_stretches_between_trials)
{
    static const double exact[] = {0x1p-20, 0x1p-14, 0x1p-10, 0x1p-8, 0x1p-7, 0.25};
    for (size_t k = 0; k < sizeof exact / sizeof *exact; k++) {
        const double pace = exact[k];
        const int trial = (int)ceil(4e-3 / pace);
        struct team team;
        double now = 1;
        team_begin(&team, 4);
        assert_true(team.most == 4 && team.size == 4 && team.trying && team.stretch == 16);
        assert_true(team.begun == 0 && team.steps == 0 && team.pace[0] == 0 && team.pace[1] == 0);
        team_step(&team, now); /* the first step is not measured */
        assert_true(team.begun == now && team.steps == 0 && team.size == 4 && team.trying);
        assert_int_equal(stretch(&team, &now, pace), trial);
        assert_true(team.size == 1 && team.trying);
        for (int times = 32; times <= 1024; times *= 2) {
            const int expected = times < 256 ? times : 256;
            assert_int_equal(stretch(&team, &now, pace), trial);
            assert_true(team.size == 4 && !team.trying && team.stretch == expected);
            const double least = ceil(expected * 4e-3 / pace);
            assert_int_equal(stretch(&team, &now, pace), (int)fmax(expected, least));
            assert_true(team.size == 1 && team.trying);
        }
        /* one thread saves < 5 %, then more: stretches are short again; then it loses 5 % */
        assert_int_equal(stretch(&team, &now, pace * 0.9500001),
                         (int)ceil(4e-3 / (pace * 0.9500001)));
        assert_true(team.size == 4 && !team.trying && team.stretch == 256);
        stretch(&team, &now, pace);
        stretch(&team, &now, pace * 0.9499999);
        assert_true(team.size == 1 && !team.trying && team.stretch == 16);
        stretch(&team, &now, pace * 0.9499999);
        assert_true(team.size == 4 && team.trying && team.stretch == 16);
        stretch(&team, &now, pace);
        assert_true(team.size == 1 && !team.trying && team.stretch == 32);
        stretch(&team, &now, pace);
        stretch(&team, &now, 0.9 * pace);
        assert_true(team.size == 4 && !team.trying && team.stretch == 16);
        /* steps that take up to 1.5 times as long, then longer: a trial follows at once */
        const double least = ceil(16 * 4e-3 / (1.3 * pace));
        assert_int_equal(stretch(&team, &now, 1.3 * pace), (int)fmax(16, least));
        assert_true(team.size == 1 && team.trying);
        stretch(&team, &now, 3 * pace);
        assert_true(team.size == 4 && !team.trying);
        const double slow = 1.3 * 1.5000001 * pace;
        assert_int_equal(stretch(&team, &now, slow), (int)ceil(4e-3 / slow));
        stretch(&team, &now, 9 * pace);
        const double quick = slow * 1.4999999;
        assert_int_equal(stretch(&team, &now, quick),
                         (int)fmax(team.stretch, ceil(team.stretch * 4e-3 / quick)));
        const uint64_t steps = team.steps;
        team_pause(&team);
        assert_true(team.begun == 0 && team.steps == steps);
        now += 100;
        team_step(&team, now);
        assert_true(team.begun == now && team.steps == 0 && team.size == 1 && team.trying);
    }
}

/* A trial ends when it has lasted exactly as long as planned. */
TEST(length_of_a_trial)
{
    struct team team;
    team_begin(&team, 2);
    team_step(&team, 4e-3);
    team_step(&team, 7.9e-3);
    assert_int_equal(team.size, 2);
    team_step(&team, 8e-3);
    assert_int_equal(team.size, 1);
}

/* Every piece of work is done once, also if there are more threads than ranges. */
TEST(every_piece_is_done_once)
{
    static const int teams[] = {1, 2, 3, 5, TEAM_SHARES, TEAM_SHARES + 6};
    for (size_t k = 0; k < sizeof teams / sizeof *teams; k++)
        for (size_t parts = 0; parts < 300; parts += parts < 9 ? 1 : 97) {
            struct team_shares shares;
            int taken[300] = {0};
            team_share(&shares, teams[k], parts);
#pragma omp parallel num_threads(teams[k])
            for (size_t p; team_next(&shares, &p);)
#pragma omp atomic
                taken[p]++;
            for (size_t p = 0; p < 300; p++) assert_int_equal(taken[p], p < parts);
        }
}

/* Each thread begins with its own range, the same one every time; then it takes pieces that other
 * threads have not begun. */
TEST(threads_begin_with_their_ranges)
{
    enum { TEAM = 3, PARTS = 11 };
    for (int again = 0; again < 20; again++) {
        struct team_shares shares;
        size_t first[TEAM] = {PARTS, PARTS, PARTS};
        int threads = 0;
        team_share(&shares, TEAM, PARTS);
#pragma omp parallel num_threads(TEAM) reduction(+ : threads)
        {
            threads = 1;
            assert_true(team_next(&shares, &first[team_thread()]));
        }
        for (int t = 0; t < threads; t++) assert_int_equal(first[t], t * PARTS / TEAM);
    }
    struct team_shares shares;
    size_t p;
    team_share(&shares, TEAM, PARTS);
    for (size_t k = 0; k < PARTS; k++) {
        assert_true(team_next(&shares, &p));
        assert_int_equal(p, k);
    }
    assert_false(team_next(&shares, &p));
}
