/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests Noh's collision and the spinning disc as problems: windows, samples, particles, how long
 * the solutions hold, and what is measured on states made by hand. (The checks `exact blast` and
 * `exact flow` test the solutions.) */
#include "test.h"

#include "disc.h"
#include "drawn_cloud.h"
#include "noh.h"
#include "shells.h"

/* ---- Noh's collision ---- */

TEST(gas_falls_in_a_ball)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 2; k++) {
            struct settings s;
            char keys[128];
            static const char *const boxes[] = {"lo=-1.5|hi=0.5", "lo=-1 -2|hi=1 1",
                                                "lo=0 0 -1|hi=4 2 2"};
            snprintf(keys, sizeof keys, "kind=noh|gamma=%s|%s", k ? "3" : "1.6", boxes[dim - 1]);
            const struct prepared p = prepared_of(&s, dim, keys);
            const double radius = 0.5, gamma = k ? 3 : 1.6; /* a quarter of the shortest side, 2 */
            for (int d = 0; d < dim; d++) {
                near_relative(p.window.hi[d] - p.window.centre[d], 0.15, 1e-14);
                near_relative(p.window.centre[d] - p.window.lo[d], 0.15, 1e-14);
            }
            if (dim > 1)
                near_relative(p.window.radius, 0.15, 1e-14);
            else
                assert_true(p.window.radius == 0);
            for (int i = 0; i <= 40; i++)
                for (int j = 0; j < 4; j++) {
                    const double r = i / 64., t = 0.125 * j;
                    double n[3];
                    const struct problem_state have = sampled(&p, r, t, n);
                    const struct noh_state want = noh_sample(gamma, dim, r, t);
                    if (dim > 1 &&
                        (fabs(r - noh_shock(gamma, t)) < 1e-9 || fabs(r + t - radius) < 1e-9))
                        continue; /* only in 1D are positions exact */
                    const bool gas = r < noh_shock(gamma, t) || r + t < radius;
                    for (int d = 0; d < 3; d++) near_absolute(have.v[d] - want.v * n[d], 0, 1e-14);
                    if (i == 0) assert_true(have.v[0] == 0);
                    if (!gas) {
                        assert_true(have.rho == 0 && have.P == 0 && have.u == 0);
                        continue;
                    }
                    near_relative(have.rho, want.rho, 1e-13);
                    near_relative(have.P, want.P > 0 ? want.P : 1e-6 * pow(want.rho, gamma), 1e-12);
                    near_relative(have.u, have.P / ((gamma - 1) * have.rho), 1e-14);
                }
        }
    struct settings s;
    struct prepared p = prepared_of(&s, 1, "kind=noh|window=-0.125 0.25");
    assert_true(p.window.lo[0] == -0.125 && p.window.hi[0] == 0.25 && p.window.radius == 0);
    p = prepared_of(&s, 2, "kind=noh|window_radius=0.25");
    assert_true(p.window.lo[0] == -1 && p.window.hi[1] == 1 && p.window.radius == 0.25);
    p = prepared_of(&s, 2, "kind=noh|window=-0.125 0.25");
    assert_true(p.window.lo[0] == -0.125 && p.window.lo[1] == -1 && p.window.radius == 0);
    /* all particles lie in the ball, as many as requested */
    p = prepared_of(&s, 2, "kind=noh|lo=-1 -2|hi=1 2|n=900");
    struct initial initial = prepared_filled(&p, &s);
    double farthest = 0;
    for (size_t i = 0; i < initial.n; i++)
        farthest = fmax(farthest, hypot(initial.x[0][i], initial.x[1][i]));
    near_inside(farthest, 0.47, 0.5);
    near_inside((double)initial.n, 850, 950);
    free(initial.storage);
    s.value[SETTING_lattice].choice = LATTICE_FCC;
    struct error error;
    assert_int_equal(p.problem->fill(&p, &s, &initial, &error), STATUS_BAD_INPUT);
}

TEST(balls_last_until_their_edge_comes)
{
    struct settings s;
    struct prepared p = prepared_of(&s, 1, "kind=noh|gamma=1.6|window=-0.125 0.25");
    lasts_until(&p, 0.25); /* the end farther from 0 counts */
    p = prepared_of(&s, 1, "kind=noh|gamma=1.6|window=-0.375 0.25");
    lasts_until(&p, 0.125);
    refused_late(&p, 0.25,
                 "t_end=%g: the gas is a ball of radius %g, whose edge falls into the window; "
                 "allowed: t_end <= %.4g, or a smaller window, or a wider box",
                 0.125, 0.5);
    p = prepared_of(&s, 3, "kind=noh|gamma=3|window_radius=0.0625"); /* the shock is as fast */
    lasts_until(&p, 0.25);
    p = prepared_of(&s, 2, "kind=noh|gamma=1.6|window_radius=0.25");
    lasts_until(&p, 0.25);
    for (int d = 0; d < 2; d++) p.window.lo[d] = -0.125 - 0.0625 * d, p.window.hi[d] = 0.0625;
    p.window.radius = 0.25; /* the window's corners are at 0.225, within the radius */
    near_relative(last_time(&p), 0.5 - hypot(0.125, 0.1875), 1e-14);
    p.window.radius = 0;
    near_relative(last_time(&p), 0.5 - hypot(0.125, 0.1875), 1e-14);
    p = prepared_of(&s, 3, "kind=noh|gamma=1.6|lo=9 19 29|hi=11 21 31"); /* not around the origin */
    for (int d = 0; d < 3; d++) p.window.lo[d] = 9.875 + 10 * d, p.window.hi[d] = 10.125 + 10 * d;
    p.window.radius = 0;
    near_relative(last_time(&p), 0.5 - 0.125 * sqrt(3), 1e-14);
}

TEST(collisions_are_measured)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            struct settings s;
            struct cloud cloud;
            struct shells shells;
            const struct prepared p = prepared_of(&s, dim, "kind=noh|gamma=1.5|lo=-0.75|hi=1.25");
            const double t = k == 2 ? 1e-6 : 0.9 * k, R = 0.25 * t, dense = pow(5, dim);
            scatter(&cloud, &p, t);
            near_relative(exactly(&p, "plateau", t), k ? dense : 1, 1e-14);
            near_relative(exactly(&p, "centre_density", t), k ? dense : 1, 1e-14);
            if (k)
                near_relative(exactly(&p, "shock_radius", t), R, 1e-14);
            else
                assert_true(exactly(&p, "shock_radius", t) == 0);
            /* the mean of both densities at the shock's radius */
            const double level = 0.5 * (dense + pow(1 + 1 / 0.25, dim - 1));
            for (int i = 0; i <= N; i++) { /* the density crosses it along the radius */
                double r = 0;
                for (int d = 0; d < dim; d++) r = hypot(r, cloud.x[d][i] - 0.25);
                cloud.m[i] = 2 * level * cloud.volume[i] / (1 + 3 * r);
            }
            shells_make(&shells, &p, &cloud.snapshot);
            assert_true(shells_crossing(&shells, level) > 0);
            if (k)
                near_relative(measured(&p, "shock_radius", &cloud.snapshot),
                              shells_crossing(&shells, level), 1e-9);
            else
                assert_true(measured(&p, "shock_radius", &cloud.snapshot) == 0);
            same(measured(&p, "plateau", &cloud.snapshot),
                 k ? shells_mean(&p, &cloud.snapshot, 0.25 * R, 0.75 * R) : 1);
            same(measured(&p, "centre_density", &cloud.snapshot),
                 k ? shells_mean(&p, &cloud.snapshot, 0, 0.25 * R) : 1);
            if (k == 1) /* the plateau has particles */
                assert_true(measured(&p, "plateau", &cloud.snapshot) > 0);
            if (k) assert_true(measured(&p, "centre_density", &cloud.snapshot) > 0);
            if (k != 1) continue;
            /* four particles, at a distance of 1e-6 of the radius inside and outside of either end
             * of the plateau */
            const double x[] = {0.25 + 0.25 * R * (1 - 5e-7), 0.25 + 0.25 * R * (1 + 5e-7),
                                0.25 + 0.75 * R * (1 - 5e-7), 0.25 + 0.75 * R * (1 + 5e-7)},
                         middle[] = {0.25, 0.25, 0.25, 0.25}, m[] = {1, 2, 4, 8},
                         V[] = {1, 1, 1, 1};
            const struct snapshot four = {
                .n = 4, .x = {x, middle, middle}, .m = m, .volume = V, .time = t};
            assert_true(measured(&p, "plateau", &four) == 3);
            assert_true(measured(&p, "centre_density", &four) == 1);
        }
}

/* ---- the spinning disc ---- */

TEST(discs_fly_apart)
{
    struct settings s;
    struct prepared p = prepared_of(&s, 2, "kind=rotation|gamma=2|lo=-1 0|hi=3 2.5");
    const double unit = 0.5; /* a fifth of the shorter side */
    near_relative(p.window.radius, unit, 1e-15);
    for (int i = 0; i <= 40; i++)
        for (int j = 0; j < 3; j++) {
            const double r = 0.0313 * i, t = 0.4 * j;
            double n[3];
            const struct problem_state have = sampled(&p, r, t, n);
            const struct disc_state want = disc_sample(1, 0.25, r / unit, t);
            assert_true((have.rho > 0) == (r < unit * disc_radius(1, 0.25, t)));
            near_absolute(have.rho - want.rho, 0, 1e-14);
            near_absolute(have.P - unit * unit * want.P, 0, 1e-15);
            near_absolute(have.v[0] - unit * (want.v_out * n[0] - want.v_along * n[1]), 0, 1e-14);
            near_absolute(have.v[1] - unit * (want.v_out * n[1] + want.v_along * n[0]), 0, 1e-14);
            assert_true(have.v[2] == 0);
            if (i == 0) assert_true(have.v[0] == 0 && have.v[1] == 0);
            if (have.rho > 0)
                near_relative(have.u, have.P / have.rho, 1e-14);
            else
                assert_true(have.P == 0 && have.u == 0);
        }
    const double last = last_time(&p);
    assert_true(disc_radius(1, 0.25, last) <= 2.25 &&
                disc_radius(1, 0.25, nextafter(last, 9)) > 2.25);
    refused_late(&p, 3,
                 "t_end=%g: the box is periodic, and the disc comes to its ends; allowed: t_end <= "
                 "%.4g, or a wider box",
                 last, 0);
    struct initial initial = prepared_filled(&p, &s);
    for (size_t i = 0; i < initial.n; i++)
        assert_true(hypot(initial.x[0][i] - 1, initial.x[1][i] - 1.25) <= unit);
    assert_true(initial.n > 400);
    free(initial.storage);
    s.value[SETTING_lattice].choice = LATTICE_FCC;
    struct error error;
    assert_int_equal(p.problem->fill(&p, &s, &initial, &error), STATUS_BAD_INPUT);

    p = prepared_of(&s, 2, "kind=rotation|gamma=2|lo=-1 0|hi=1 4");
    near_relative(p.window.radius, 0.4, 1e-15);
    p = prepared_of(&s, 2, "kind=rotation|gamma=2|window_radius=0.125");
    assert_true(p.window.radius == 0.125);
    p = prepared_of(&s, 2, "kind=rotation|gamma=2|window=-0.5 0.5");
    assert_true(p.window.radius == 0);
    p = prepared_of(&s, 2, "kind=rotation|gamma=2.0000000000009");
    p = prepared_of(&s, 2, "kind=rotation|gamma=1.9999999999991");
    prepared_refused(2, "kind=rotation|gamma=2.0000000000011",
                     "gamma=2: the expansion of a spinning disc is known for gamma=2");
    prepared_refused(2, "kind=rotation|gamma=1.9999999999989", "known for gamma=2");
}

TEST(discs_are_measured)
{
    struct settings s;
    struct cloud cloud;
    const struct prepared p = prepared_of(&s, 2, "kind=rotation|gamma=2|lo=-1 0|hi=3 2.5");
    scatter(&cloud, &p, 0.5);
    double mass = 0, inertia = 0, turning = 0;
    for (int i = 0; i < N; i++) {
        const double x = cloud.x[0][i] - 1, y = cloud.x[1][i] - 1.25;
        mass += cloud.m[i];
        inertia += cloud.m[i] * (x * x + y * y);
        turning += cloud.m[i] * (x * cloud.v[1][i] - y * cloud.v[0][i]);
    }
    near_relative(measured(&p, "disc_radius", &cloud.snapshot), sqrt(2 * inertia / mass), 1e-12);
    near_relative(measured(&p, "angular_speed", &cloud.snapshot), turning / inertia, 1e-11);
    near_relative(exactly(&p, "disc_radius", 0.8), 0.5 * sqrt(1 + 1.5 * 0.64), 1e-14);
    near_relative(exactly(&p, "angular_speed", 0.8), 1 / (1 + 1.5 * 0.64), 1e-14);
}
