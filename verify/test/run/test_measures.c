/* SPDX-License-Identifier: GPL-3.0-or-later
 * What runs are measured by, on hand-made particles and by hand: windows, shells, growth, means and
 * error budgets. */
#include "test.h"

#include "near.h"

#include <stdlib.h>
#include <string.h>

#include "functional.h"
#include "growth.h"
#include "run_part.h"
#include "shells.h"
#include "value.h"

TEST(test_window)
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

TEST(test_growth)
{
    struct growth growth = {0};
    const double t[] = {1, 2, 4, 5}, y[] = {0.5, 1.5, 2, 4};
    for (int k = 0; k < 4; k++) {
        assert_true(isnan(growth_rate(&growth)) == (k < 3));
        growth_see(&growth, t[k], exp(y[k]));
    }
    near_relative(growth_rate(&growth), 7.5 / 10, 1e-14); /* means 3 and 2 */
    struct growth none = growth;
    growth_see(&none, 6, 0);
    assert_true(isnan(growth_rate(&none)));
    growth_see(&growth, 6, -1);
    assert_true(isnan(growth_rate(&growth)));
}

/* A problem without one: P = 2 + x, and two regions that meet at x = 1. */
static double seen_reach, seen_time;

static void sample(const struct prepared *p, const double x[3], double t, struct problem_state *s)
{
    (void)p;
    *s = (struct problem_state){.rho = 1, .P = 2 + x[0] + t, .u = 10 + 4 * x[0] - t};
}

static size_t region_at(const struct prepared *p, const double x[3], double reach, double t)
{
    (void)p;
    seen_reach = reach, seen_time = t;
    return (size_t) !(x[0] < 1);
}

static double still(const struct prepared *p, const struct snapshot *s)
{
    (void)p;
    return 0.25 * (double)s->n;
}

static const struct regions regions = {{"left", "right", NULL}, region_at, still};

static const struct problem problem = {.sample = sample, .regions = &regions};

enum { N = 5 }; /* and one behind them */

static const double x[3][N + 1] = {
    {0, 0.5, 1, 2, 2.5, 1.5}, {0, 1, 0, 1, 0, 1.5}, {0, 0, 2, 0, 1, 1.5}};
static const double v[3][N + 1] = {
    {1, 2, 3, 4, 5, 1.5}, {0, 1, 2, 3, 4, 1.5}, {5, 4, 3, 2, 1, 1.5}};
static const double m[N + 1] = {1, 2, 3, 4, 50, 1.5}, rho[N + 1] = {1, 2, 1, 4, 9, 1.5},
                          u[N + 1] = {3, 1, 4, 1, 90, 1.5}, P[N + 1] = {1, 2, 4, 8, 90, 1.5},
                          h[N + 1] = {1, 2, 3, 4, 5, 1.5},
                          volume[N + 1] = {0.5, 1, 2, 0.25, 70, 1.5};

static const struct snapshot snapshot = {.n = N,
                                         .x = {x[0], x[1], x[2]},
                                         .v = {v[0], v[1], v[2]},
                                         .m = m,
                                         .rho = rho,
                                         .u = u,
                                         .P = P,
                                         .h = h,
                                         .volume = volume,
                                         .time = 0};

static struct prepared prepared_in(int dim)
{
    return (struct prepared){.problem = &problem,
                             .domain = {dim, {-4, -4, -4}, {4, 4, 4}},
                             .window = {.dim = dim, .lo = {0, 0, 0}, .hi = {2, 2, 2}},
                             .boundary = {BOUNDARY_OPEN, BOUNDARY_OPEN, BOUNDARY_OPEN},
                             .gamma = 1.5};
}

/* Means over the first four particles: the fifth is not in the window. */
TEST(test_functionals)
{
    const double V = 0.5 + 1 + 2 + 0.25;
    for (int dim = 1; dim <= 3; dim++) {
        const struct prepared p = prepared_in(dim);
        near_relative(functional_window_mean(&p, &snapshot, P), (0.5 + 2 + 8 + 2) / V, 1e-15);
        near_relative(functional_mean_pressure.measure(&p, &snapshot), 12.5 / V, 1e-15);
        near_relative(functional_mean_internal_energy.measure(&p, &snapshot),
                      (1.5 + 1 + 8 + 0.25) / V, 1e-15);
        assert_true(functional_mean_pressure.present(&p) == (dim == 1));
        assert_true(functional_mean_internal_energy.present(&p) == (dim == 1));
        double sum = 0;
        for (int i = 0; i < 4; i++) {
            double squares = 0;
            for (int d = 0; d < dim; d++) squares += v[d][i] * v[d][i];
            sum += volume[i] * squares * rho[i] / (1.5 * P[i]);
        }
        near_relative(functional_velocity_rms.measure(&p, &snapshot), sqrt(sum / V), 1e-15);
        assert_true(functional_velocity_rms.exact(&p, 1) == 0);
    }
    const struct prepared p = prepared_in(1);
    near_relative(functional_mean_pressure.exact(&p, 0.5), 3.5, 1e-10);
    near_relative(functional_mean_internal_energy.exact(&p, 0.5), 13.5, 1e-10);
}

TEST(test_budget)
{
    struct prepared p = prepared_in(1);
    static const double exact[FIELDS][N] = {
        {2, 2, 2, 2, 2}, {0, 0, 0, 0, 0}, {0, 3, 4, 6, 0}, {4, 4, 4, 4, 4}};
    const double *const values[] = {exact[0], exact[1], exact[2], exact[3]};
    struct budget budget;
    run_measure_budget(&p, &snapshot, values, &budget);
    /* of the volumes 0.25, 1, 2, 0.125 and 2 lie in the window */
    static const double expected[2][FIELDS] = {{0.25, 2.25, 1.25, 3.25},
                                               {16.25, 16.5, 180.25, 172.375}};
    for (int r = 0; r < 2; r++)
        for (int f = 0; f < FIELDS; f++)
            near_relative(budget.l1[r][f], expected[r][f] / 5.375, 1e-15);
    assert_true(seen_reach == BUDGET_REACH * 5 && seen_time == 0);
    assert_true(budget.still == 1.25 && budget.regions == &regions);

    json_t *json = run_budget_json(&budget);
    for (int r = 0; r < 2; r++)
        for (int f = 0; f < FIELDS; f++)
            near_relative(value_inner(json, regions.names[r], field_family.members[f]->name),
                          budget.l1[r][f], 1e-15);
    assert_true(value_member(json, "still") == 1.25);
    json_decref(json);

    budget.still = NAN;
    json = run_budget_json(&budget);
    assert_true(json_is_null(json_object_get(json, "still")));
    assert_int_equal(json_object_size(json), 3);
    assert_int_equal(json_object_size(json_object_get(json, "right")), FIELDS);
    json_decref(json);
    struct problem none = problem;
    none.regions = NULL;
    p.problem = &none;
    run_measure_budget(&p, &snapshot, values, &budget);
    assert_true(!budget.regions && isnan(budget.still));
    json = run_budget_json(&budget);
    assert_true(json_is_null(json));
    json_decref(json);
}

TEST(test_shells)
{
    struct prepared p = prepared_in(2);
    p.domain = (struct domain){2, {-1, -2}, {1, 2}};
    p.window = (struct window){.dim = 2, .lo = {-1, -1}, .hi = {1, 1}};
    /* four in the window, 1/4 apart; beyond it a large one, and one beyond all shells */
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
    s.volume = fine; /* no more shells than there is room for */
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
