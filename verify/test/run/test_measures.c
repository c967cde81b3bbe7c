/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests windows and shells on particles made by hand. (Whole runs, test_mode.c and the transcripts
 * test growth, means and error budgets.) */
#include "test.h"

#include "run_part.h"
#include "shells.h"

TEST(particles_in_windows)
{
    const double lo[] = {-1, -2, -3}, hi[] = {1, 2, 3};
    for (int dim = 1; dim <= 3; dim++) {
        struct window window = {.dim = dim, .lo = {-1, -2, -3}, .hi = {1, 2, 3}};
        for (int d = 0; d < 3; d++)
            for (int side = 0; side < 2; side++) {
                double x[3] = {0.5, 0.5, 0.5};
                x[d] = side ? hi[d] : lo[d];
                assert_true(window_contains(&window, x));
                x[d] *= 1 + 1e-15;
                assert_true(window_contains(&window, x) == (d >= dim));
                x[d] = NAN;
                assert_true(window_contains(&window, x) == (d >= dim));
            }
    }
    struct window ball = {.dim = 2, .lo = {-5, -5}, .hi = {7, 7}, .centre = {1, 1}, .radius = 5};
    assert_true(window_contains(&ball, (double[]){4, 5, 99}));
    assert_true(window_contains(&ball, (double[]){-2, -3, 99}));
    assert_false(window_contains(&ball, (double[]){4, 5.000001, 0}));
    assert_false(window_contains(&ball, (double[]){-2, -3.000001, 0}));
    assert_false(window_contains(&ball, (double[]){7, 7, 0}));
    const struct {
        struct window window;
        const char *text;
    } rows[] = {
        {{.dim = 1, .lo = {-1, 8}, .hi = {2, 9}}, "[-1.0,2.0]"},
        {{.dim = 2, .lo = {-1, 0, 8}, .hi = {2, 3, 9}}, "{\"lo\":[-1.0,0.0],\"hi\":[2.0,3.0]}"},
        {{.dim = 3, .centre = {1, 2, 3}, .radius = 4}, "{\"centre\":[1.0,2.0,3.0],\"radius\":4.0}"},
        {{.dim = 1, .centre = {1, 2, 3}, .radius = 4}, "{\"centre\":[1.0],\"radius\":4.0}"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        json_t *json = run_window_json(&rows[k].window);
        char *text = json_dumps(json, JSON_COMPACT);
        assert_string_equal(text, rows[k].text);
        free(text);
        json_decref(json);
    }
}

TEST(means_of_shells)
{
    const struct prepared p = {.domain = {2, {-1, -2}, {1, 2}},
                               .window = {.dim = 2, .lo = {-1, -1}, .hi = {1, 1}}};
    /* four in the window, 1/4 apart; outside of it a large one, and one beyond all shells */
    const double px[] = {0.1, 0, 0.3, -0.5, 0, 1, 0.2}, py[] = {0, 0.2, 0.4, 0, -1.5, 0, 0.2},
                 mass[] = {1, 2, 3, 4, 5, 6, 7},
                 V[] = {0.09375, 0.03125, 0.0625, 0.0625, 9, 0.0625, 0.5};
    struct snapshot s = {.n = 6, .x = {px, py}, .m = mass, .volume = V};
    struct shells shells;
    shells.density[4] = 1234;
    shells_make(&shells, &p, &s);
    assert_true(shells.density[4] == 1234);
    near_relative(shells.width, 0.25, 1e-15);
    assert_int_equal(shells.n, 4);
    near_relative(shells.density[0], 3 / 0.125, 1e-15);
    assert_true(isnan(shells.density[1]) && isnan(shells.density[3]));
    near_relative(shells.density[2], 7 / 0.125, 1e-15);
    near_relative(shells_peak(&shells), 7 / 0.125, 1e-15);
    near_relative(shells_mean(&p, &s, 0.1, 0.5), 3 / 0.125, 1e-15);
    near_relative(shells_mean(&p, &s, 0.05, 0.51), 10 / 0.25, 1e-15);
    assert_true(isnan(shells_mean(&p, &s, 0.21, 0.49)));
    double fine[7];
    for (int i = 0; i < 7; i++) fine[i] = 1e-8;
    s.volume = fine; /* at most SHELLS_MAX shells */
    shells_make(&shells, &p, &s);
    assert_int_equal(shells.n, SHELLS_MAX);
    near_relative(shells.width, 1. / SHELLS_MAX, 1e-15);
    int filled = 0;
    for (int k = 0; k < SHELLS_MAX; k++) filled += !isnan(shells.density[k]);
    assert_int_equal(filled, 3);
    for (int i = 0; i < 7; i++) fine[i] = 0;
    shells_make(&shells, &p, &s);
    assert_int_equal(shells.n, 0);
    shells = (struct shells){.n = 3, .density = {9, 2, 3, 100}};
    assert_true(shells_peak(&shells) == 9);
    shells = (struct shells){.n = 2, .density = {1, 2, 100}};
    assert_true(shells_peak(&shells) == 2);
    s.n = 0;
    shells_make(&shells, &p, &s);
    assert_int_equal(shells.n, 0);
    assert_true(isnan(shells_peak(&shells)));

    const struct {
        size_t n;
        double density[5], level, radius;
    } rows[] = {
        {5, {4, 4, NAN, 2, 1}, 3, 2.5}, {5, {4, 4, NAN, 2, 1}, 4, 1.5},
        {3, {5, 1, 6, 9, 9}, 4, 0.75},  {4, {1, 9, 1, 0, 9}, 5, 2},
        {2, {1, 1, 9, 9, 9}, 3, -1},    {5, {NAN, NAN, 8, 4, NAN}, 5, 3.25},
        {1, {9, 0, 0, 0, 0}, 5, -1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        shells = (struct shells){.n = rows[k].n, .width = 2};
        memcpy(shells.density, rows[k].density, sizeof rows[k].density);
        const double found = shells_crossing(&shells, rows[k].level);
        if (rows[k].radius < 0)
            assert_true(isnan(found));
        else
            near_relative(found, 2 * rows[k].radius, 1e-15);
    }
}
