/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests profiles of runs in 1D on a made-up gas: the exact curve has points exactly where one of
 * its fields bends, and the particles are those of the window. */
#include "test.h"

#include "keyed.h"
#include "run_output.h"
#include "value.h"

enum { N = 4 };
static double curvature; /* of the velocity, over its size */

/* Straight lines with one bend each: rho at 0.25, v at 0.4, P at 0.625 and beyond the window, u at
 * 0.5. */
static void sample(const struct prepared *p, const double at[3], double t, struct problem_state *s)
{
    const double x = at[0];
    (void)p;
    *s = (struct problem_state){.rho = 2 + fabs(x - 0.25),
                                .v = {3 + 2 * fabs(x - 0.375) + t},
                                .P = 5 + fabs(x - 0.625) + fabs(x - 1.001),
                                .u = 7 - fabs(x - 0.5)};
    if (curvature > 0)
        *s = (struct problem_state){.rho = 1, .v = {1e3 + curvature * x * x}, .P = 1, .u = 1};
}

static const double x[N + 1] = {0.125, 0.75, 1.5, 1, 0.5};
static const double rho[N + 1] = {1, 2, 3, 4, 5}, v[N + 1] = {6, 7, 8, 9, 10},
                            P[N + 1] = {11, 12, 13, 14, 15};

static json_t *made(struct problem *problem)
{
    static struct run_result result;
    const struct run run = keyed_run("sod", "");
    result = (struct run_result){.problem = run.problem, .time = 0.5};
    *problem = *run.problem.problem;
    problem->sample = sample;
    result.problem.problem = problem;
    result.problem.window = (struct window){.dim = 1, .lo = {0}, .hi = {1}, .centre = {0.5}};
    result.snapshot =
        (struct snapshot){.n = N, .x = {x}, .v = {v}, .rho = rho, .P = P, .time = 0.5};
    return profile_json(&result);
}

static double at(const json_t *object, const char *name, size_t i)
{
    return value_real(json_array_get(json_object_get(object, name), i));
}

TEST(points_at_bends)
{
    static const double want[] = {0, 0.25, 0.375, 0.5, 0.625, 1};
    struct problem problem;
    curvature = 0;
    json_t *profile = made(&problem), *exact = json_object_get(profile, "exact");
    assert_int_equal(json_array_size(json_object_get(exact, "x")), 6);
    for (size_t i = 0; i < 6; i++) {
        struct problem_state s;
        sample(NULL, &want[i], 0.5, &s);
        near_absolute(1 + at(exact, "x", i), 1 + want[i], 1e-12);
        near_relative(at(exact, "density", i), s.rho, 1e-12);
        near_relative(at(exact, "velocity", i), s.v[0], 1e-12);
        near_relative(at(exact, "pressure", i), s.P, 1e-12);
    }
    assert_int_equal(json_object_size(exact), 4);
    static const size_t shown[] = {0, 1, 3}; /* those in the window, its end included */
    assert_int_equal(json_array_size(json_object_get(profile, "x")), 3);
    for (size_t i = 0; i < 3; i++) {
        struct problem_state s;
        const size_t k = shown[i];
        sample(NULL, &x[k], 0.5, &s);
        assert_true(at(profile, "x", i) == x[k] && at(profile, "density", i) == rho[k] &&
                    at(profile, "velocity", i) == v[k] && at(profile, "pressure", i) == P[k]);
        assert_true(at(profile, "exact_density", i) == s.rho &&
                    at(profile, "exact_velocity", i) == s.v[0] &&
                    at(profile, "exact_pressure", i) == s.P);
    }
    assert_int_equal(json_object_size(profile), 8);
    json_decref(profile);
}

/* A curve that bends by 1e-9 of its values from point to point counts as straight. */
TEST(nearly_straight_curves)
{
    struct problem problem;
    for (int side = -1; side <= 1; side += 2) {
        curvature = 1 + 0.01 * side; /* 2 c dx^2 over 2 v, dx = 1/1000 */
        json_t *profile = made(&problem);
        assert_int_equal(json_array_size(json_object_get(json_object_get(profile, "exact"), "x")) ==
                             1001,
                         side > 0);
        json_decref(profile);
    }
}
