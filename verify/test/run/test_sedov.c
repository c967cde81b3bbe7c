/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests Sedov's blast as a problem: the initial energy, samples, how long the solution holds, and
 * what is measured on states made by hand. (The check `exact blast` tests the solution.) */
#include "test.h"

#include "drawn_cloud.h"
#include "sedov.h"
#include "shells.h"

static void check_hot_spot(int dim, const char *keys)
{
    struct settings s;
    const struct prepared p = prepared_of(&s, dim, keys);
    const struct initial initial = prepared_filled(&p, &s);
    double volume = 1, sum = 0, energy = 0;
    for (int d = 0; d < dim; d++) volume *= domain_length(&p.domain, d);
    const double spacing = pow(volume / (double)initial.n, 1. / dim);
    int hot = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < initial.n; i++) {
            double r = 0;
            for (int d = 0; d < dim; d++) r = hypot(r, initial.x[d][i] - p.window.centre[d]);
            const double q = r / (2.5 * spacing), w = q < 1 ? pow(1 - q * q, 2) : 0;
            if (pass == 0) {
                sum += initial.m[i] * w;
                continue;
            }
            hot += q < 1;
            near_relative(initial.u[i], 1e-6 / 0.6 + w / sum, 1e-12);
            near_relative(initial.m[i], volume / (double)initial.n, 1e-13);
            assert_true(initial.rho[i] == 1 && initial.v[0][i] == 0);
            energy += initial.m[i] * initial.u[i];
        }
    near_relative(energy, 1 + volume * 1e-6 / 0.6, 1e-12);
    assert_true(hot >= 4 && hot < 100);
    free(initial.storage);
    struct initial none = {.n = 3}; /* left by an earlier call */
    struct error error;
    s.value[SETTING_n].real[0] = 0x1p53;
    assert_int_equal(p.problem->fill(&p, &s, &none, &error), STATUS_ENVIRONMENT);
}

TEST(blasts_start_from_a_hot_spot)
{
    check_hot_spot(2, "kind=sedov|gamma=1.6|lo=-1 0|hi=2 2|n=400");
    check_hot_spot(3, "kind=sedov|gamma=1.6|lo=-1 0 0|hi=2 2 2|n=900");
    /* a cell of a by 1/a: the position 5 a/2, 1/(2 a) is 2.5 (1 + 5e-7) from the middle */
    const double far = 6.25 * (1 + 1e-6), a = sqrt((far + sqrt(far * far - 6.25)) / 12.5);
    char keys[128];
    snprintf(keys, sizeof keys, "kind=sedov|gamma=1.6|lo=0|hi=%.17g %.17g|n=400", 20 * a, 20 / a);
    check_hot_spot(2, keys);
}

/* With too few particles the front reaches its images: the run that the message allows is
 * allowed. */
TEST(blasts_that_meet_their_images)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct settings s;
        struct error error;
        const struct prepared p = prepared_of(&s, dim, "kind=sedov|gamma=1.6|lo=-1|hi=2");
        double *t = s.value[SETTING_t_end].real, *n = s.value[SETTING_n].real, side, power, longest;
        const double shock = 1.2; /* 4 spacings of 3/10 more: the limit, 2.4 */
        *t = last_time(&p) * pow(shock / 1.35, 0.5 * dim + 1);
        for (int k = 4; k <= 12; k++) {
            struct initial initial = {0};
            *n = pow(k, dim);
            assert_int_equal(p.problem->fill(&p, &s, &initial, &error),
                             k < 10 ? STATUS_BAD_INPUT : STATUS_OK);
            free(initial.storage);
            if (k >= 10) continue;
            const char *allowed = strstr(error.message, "allowed: n >= ");
            const double space = 2.4 - 12. / k; /* limit of the shock; k = 4, 5: none */
            assert_non_null(allowed);
            assert_int_equal(
                sscanf(allowed, "allowed: n >= %lf^%lf, or t_end <= %lf", &side, &power, &longest),
                space > 1e-9 ? 3 : 2);
            assert_true(side == 10 && power == dim);
            if (!(space > 1e-9)) continue;
            const double last = *t * pow(space / shock, 0.5 * dim + 1);
            near_relative(longest, last, 0.01);
            assert_true(longest < last);
        }
    }
}

TEST(blasts_run_outwards)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct settings s;
        struct sedov blast;
        const struct prepared p =
            prepared_of(&s, dim,
                        dim == 2 ? "kind=sedov|gamma=1.05|lo=-1 0|hi=2 1.5"
                                 : "kind=sedov|gamma=1.05|lo=0 -1 0|hi=2 2 3");
        assert_null(sedov_solve(1.05, dim, 1, 1, &blast));
        for (int i = 0; i <= 40; i++)
            for (int j = 0; j < 3; j++) {
                const double r = i / 40., t = j == 2 ? 5e-7 : 0.2 * j;
                double n[3];
                const struct problem_state have = sampled(&p, r, t, n);
                struct sedov_state want = {1, 0, 0};
                if (j) want = sedov_sample(&blast, r, t);
                if (want.rho > 0) {
                    near_relative(have.rho, want.rho, 1e-10);
                    near_relative(have.u, have.P / ((p.gamma - 1) * have.rho), 1e-14);
                } else
                    assert_true(have.rho == 0 && have.u == 0);
                near_relative(have.P, fmax(want.P, 1e-6), 1e-11);
                for (int d = 0; d < 3; d++)
                    near_absolute(have.v[d] - want.v * n[d], 0, 1e-8 * (1 + fabs(want.v)));
                if (i == 0) assert_true(have.v[0] == 0);
                if (i == 0 && j) assert_true(have.rho == 0); /* the density underflows */
            }
        /* while the shock is within 9/10 of the distance to the nearest end */
        const double last = last_time(&p);
        const double half = dim == 2 ? 0.75 : 1;
        assert_true(sedov_shock(&blast, last) <= 0.9 * half &&
                    sedov_shock(&blast, nextafter(last, 9)) > 0.9 * half);
        refused_late(&p, 3,
                     "t_end=%g: the box is periodic, and the shock comes to its ends (it would be "
                     "at %.4g); allowed: t_end <= %.4g, or a wider box",
                     last, sedov_shock(&blast, 3));
    }
    prepared_refused(2, "kind=sedov|gamma=2",
                     "no exact solution: gamma must be no nearer to 2 than 1e-3");
}

TEST(blasts_are_measured)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            struct settings s;
            struct cloud cloud;
            struct shells shells;
            struct sedov blast;
            const double t = k == 2 ? 5e-7 : 0.3 * k;
            const struct prepared p = prepared_of(&s, dim, "kind=sedov|gamma=1.6|lo=-0.75|hi=1.25");
            assert_null(sedov_solve(1.6, dim, 1, 1, &blast));
            scatter(&cloud, &p, t);
            for (int i = 0; i <= N; i++) cloud.m[i] *= 0.02;
            shells_make(&shells, &p, &cloud.snapshot);
            const double top = shells_peak(&shells);
            near_relative(measured(&p, "peak_density", &cloud.snapshot), top, 1e-15);
            near_relative(exactly(&p, "peak_density", t), k ? 2.6 / 0.6 : 1, 1e-14);
            if (k) {
                assert_true(shells_crossing(&shells, 0.5 * (1 + top)) > 0);
                struct snapshot other = cloud.snapshot; /* values are not cached */
                other.m = cloud.volume;
                measured(&p, "peak_density", &other);
                same(measured(&p, "shock_radius", &cloud.snapshot),
                     shells_crossing(&shells, 0.5 * (1 + top)));
                near_relative(exactly(&p, "shock_radius", t), sedov_shock(&blast, t), 1e-15);
            } else {
                assert_true(measured(&p, "shock_radius", &cloud.snapshot) == 0);
                assert_true(exactly(&p, "shock_radius", t) == 0);
            }
        }
}

/* The integral of r^(d - 1) times the integrand, by midpoints in (r/R)^(1/2), which resolve the
 * front. */
static double behind(const struct sedov *blast, int what, double t)
{
    const double R = sedov_shock(blast, t), unit = blast->d == 2 ? 2 * M_PI : 4 * M_PI;
    double sum = 0;
    for (int i = 0; i < 4000; i++) {
        const double y = (i + 0.5) / 4000, r = R * sqrt(y);
        const struct sedov_state s = sedov_sample(blast, r, t);
        const double of[] = {0.5 * s.rho * s.v * s.v, s.rho * s.v, s.P, s.P * r};
        sum += unit * of[what] * pow(r, blast->d - 2) * R * R / 2 / 4000;
    }
    return sum;
}

static double of_motion(double r, const struct sedov_state *s)
{
    (void)r;
    return s->rho * s->v * s->v / 2;
}

/* Sums over all gas: kinetic energy, outward momentum, position of the heat, asymmetry between
 * directions. */
TEST(blasts_are_summed)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct settings s;
        struct cloud cloud;
        struct sedov blast;
        const struct prepared p = prepared_of(&s, dim, "kind=sedov|gamma=1.6|lo=-0.75|hi=1.25");
        const double t = 0.3, centre = 0.25;
        assert_null(sedov_solve(1.6, dim, 1, 1, &blast));
        scatter(&cloud, &p, t);
        cloud.snapshot.u = cloud.volume;
        double kinetic = 0, outward = 0, heat = 0, spread = 0, flow[3][3] = {{0}}, first[3] = {0};
        double trace = 0, sizes = 0, worst = 0;
        for (int i = 0; i < N; i++) {
            double r = 0, squares = 0, along = 0;
            for (int a = 0; a < dim; a++) {
                const double x = cloud.x[a][i] - centre, v = cloud.v[a][i];
                r = hypot(r, x), squares += v * v, along += v * x;
                for (int b = 0; b < dim; b++)
                    flow[a][b] += cloud.m[i] * v * (cloud.x[b][i] - centre);
            }
            for (int a = 0; a < dim; a++) {
                first[a] += cloud.m[i] * squares * (cloud.x[a][i] - centre);
                sizes += cloud.m[i] * squares * fabs(cloud.x[a][i] - centre);
            }
            kinetic += cloud.m[i] * squares / 2;
            outward += r > 0 ? cloud.m[i] * along / r : 0;
            trace += cloud.m[i] * along / dim;
            heat += cloud.m[i] * cloud.volume[i], spread += r * cloud.m[i] * cloud.volume[i];
        }
        for (int a = 0; a < dim; a++) {
            worst = fmax(worst, fabs(first[a] / sizes));
            for (int b = 0; b < dim; b++)
                worst = fmax(worst, fabs(flow[a][b] / trace - (a == b ? 1 : 0)));
        }
        near_relative(measured(&p, "kinetic_energy", &cloud.snapshot), kinetic, 1e-13);
        near_relative(measured(&p, "outward_momentum", &cloud.snapshot), outward, 1e-12);
        near_relative(measured(&p, "thermal_radius", &cloud.snapshot), spread / heat, 1e-13);
        near_relative(measured(&p, "asymmetry", &cloud.snapshot), worst, 1e-11);
        cloud.snapshot.time = 0;
        assert_true(measured(&p, "asymmetry", &cloud.snapshot) == 0);
        near_relative(exactly(&p, "kinetic_energy", t), behind(&blast, 0, t), 1e-5);
        near_relative(exactly(&p, "kinetic_energy", t),
                      sedov_integral(&blast, sedov_shock(&blast, t), t, of_motion), 1e-9);
        near_relative(exactly(&p, "outward_momentum", t), behind(&blast, 1, t), 1e-5);
        near_relative(exactly(&p, "thermal_radius", t), behind(&blast, 3, t) / behind(&blast, 2, t),
                      1e-5);
        assert_true(exactly(&p, "kinetic_energy", 0) == 0 &&
                    exactly(&p, "outward_momentum", 0) == 0 &&
                    exactly(&p, "thermal_radius", 0) == 0);
    }
}

static double nothing_but_mass(double r, const struct sedov_state *s)
{
    (void)r;
    return s->rho;
}

static double pressure_alone(double r, const struct sedov_state *s)
{
    (void)r;
    return s->P;
}

/* The energy of a given mass in a ball around the middle: before the blast that of the cold gas. */
TEST(energy_of_a_ball)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct settings s;
        struct sedov blast;
        const struct prepared p = prepared_of(&s, dim, "kind=sedov|gamma=1.6|lo=-0.75|hi=1.25");
        assert_null(sedov_solve(1.6, dim, 1, 1, &blast));
        near_relative(p.problem->mean_energy(&p, 0.1, 0), 1e-6 / 0.6, 1e-14);
        near_relative(p.problem->mean_energy(&p, 0.1, 0.3),
                      sedov_integral(&blast, 0.1, 0.3, pressure_alone) / 0.6 /
                          sedov_integral(&blast, 0.1, 0.3, nothing_but_mass),
                      1e-13);
    }
}

/* One particle on either side of the middle along every axis, the light one twice as fast: outward
 * momentum is the same everywhere, but one side has more kinetic energy. */
TEST(one_side_is_faster)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct settings s;
        struct cloud cloud = {0};
        const struct prepared p = prepared_of(&s, dim, "kind=sedov|gamma=1.6|lo=-0.75|hi=1.25");
        for (int i = 0; i < 2 * dim; i++) {
            const int side = i % 2 ? -1 : 1;
            for (int d = 0; d < dim; d++) cloud.x[d][i] = 0.25;
            cloud.x[i / 2][i] += 0.5 * side;
            cloud.v[i / 2][i] = (i % 2 ? 1 : 2) * side;
            cloud.m[i] = i % 2 ? 2 : 1;
            cloud.volume[i] = 1 + i;
        }
        cloud.m[2 * dim] = 7;
        cloud.snapshot = (struct snapshot){.n = 2 * (size_t)dim,
                                           .x = {cloud.x[0], cloud.x[1], cloud.x[2]},
                                           .v = {cloud.v[0], cloud.v[1], cloud.v[2]},
                                           .m = cloud.m,
                                           .u = cloud.volume,
                                           .time = 0.3};
        near_relative(measured(&p, "asymmetry", &cloud.snapshot), 1. / (3 * dim), 1e-15);
        near_relative(measured(&p, "kinetic_energy", &cloud.snapshot), 3 * dim, 1e-15);
        cloud.v[1][0] = 1, cloud.v[1][1] = -0.5; /* and along y on either side */
        near_relative(measured(&p, "asymmetry", &cloud.snapshot), 0.5, 1e-15);
        near_relative(measured(&p, "outward_momentum", &cloud.snapshot), 4 * dim, 1e-15);
        near_relative(measured(&p, "thermal_radius", &cloud.snapshot), 0.5, 1e-15);
    }
}

/* If the initial state prefers no direction, asymmetry is an error. */
TEST(symmetry_is_known)
{
    static const struct {
        const char *words;
        int dim;
        bool known;
    } rows[] = {{"", 2, true},
                {"", 3, true},
                {"lattice=cubic", 3, true},
                {"lattice=square|jitter=0.1", 2, false},
                {"lattice=jittered", 3, false},
                {"lattice=fcc", 3, false},
                {"lattice=hexagonal", 2, false},
                {"lattice=glass", 2, false},
                {"lo=-0.5,-0.5|hi=0.5,0.6", 2, false},
                {"lo=-0.5,-0.5,-0.5|hi=0.5,0.5,0.6", 3, false}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct settings s;
        char words[120];
        snprintf(words, sizeof words, "kind=sedov|gamma=1.6%s%s", *rows[k].words ? "|" : "",
                 rows[k].words);
        const struct prepared p = prepared_of(&s, rows[k].dim, words);
        same(exactly(&p, "asymmetry", 0.1), rows[k].known ? 0 : (double)NAN);
    }
}
