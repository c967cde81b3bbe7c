/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares every number that the library returns for random input with a plain calculation or the
 * exact solution, and tests every refusal. In place of a gradient operator it checks a function
 * with known results. */
#include "test.h"

#include "gradient_study.h"
#include "noh.h"
#include "order.h"
#include "riemann.h"
#include "sedov.h"
#include "settings.h"
#include "simple_wave.h"
#include "sphproof/gradients.h"
#include "sphproof/rates.h"
#include "sphproof/simulations.h"
#include "sphproof/solutions.h"
#include "vortex.h"

static uint64_t seed = 26;
static double uniform(double lo, double hi)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (double)(seed >> 11) / 9007199254740992.;
}

static struct sphproof_error error;

static void refused(enum sphproof_status status, const char *says)
{
    if (status != SPHPROOF_BAD_INPUT || error.status != status || !strstr(error.message, says))
        fail_msg("status %d, '%s' is not in: %s", (int)status, says, error.message);
}

/* ---- solutions ---- */

enum { PLACES = 6 };
static double at[PLACES + 1], found[3][PLACES + 1];

/* n places, of which the first is lo; no place is behind them. */
static void draw_places(size_t n, double lo, double hi)
{
    for (int i = 0; i < PLACES; i++) at[i] = uniform(lo, hi);
    at[0] = lo, at[n] = (double)NAN;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i <= PLACES; i++) found[k][i] = -77;
}

static void state_is(int i, double rho, double v, double P)
{
    assert_true(found[0][i] == rho && found[1][i] == v && found[2][i] == P);
}

/* Nothing is written after element n - 1. */
static void ends_at(size_t n)
{
    for (int k = 0; k < 3; k++) assert_true(found[k][n] == -77);
}

TEST(solutions)
{
    double *const rho = found[0], *const v = found[1], *const P = found[2];
    for (size_t n = 0; n <= PLACES; n++) {
        const int count = (int)n;
        const double t = n ? uniform(0.1, 0.3) : 0, gamma = uniform(1.2, 2), x0 = uniform(-1, 1);
        const double left[3] = {uniform(0.5, 1), uniform(-1, 1), uniform(0.5, 1)},
                     right[3] = {uniform(0.1, 0.5), uniform(-1, 1), uniform(0.1, 0.5)};
        struct riemann_solution tube;
        struct sphproof_star star;
        struct sedov sedov;
        double shock = 0;
        assert_null(riemann_solve(gamma, &(struct riemann_state){left[0], left[1], left[2]},
                                  &(struct riemann_state){right[0], right[1], right[2]}, &tube));
        draw_places(n, -1, 1);
        assert_int_equal(
            sphproof_solutions_riemann(gamma, left, right, x0, t, n, at, rho, v, P, &error),
            SPHPROOF_OK);
        for (int i = 0; i < count; i++) {
            const struct riemann_state s = riemann_sample(&tube, at[i], x0, t);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
        assert_int_equal(sphproof_solutions_star(gamma, left, right, &star, &error), SPHPROOF_OK);
        const double speeds[] = {tube.left_head, tube.left_tail, tube.contact, tube.right_tail,
                                 tube.right_head};
        assert_true(star.P == tube.p_star && star.v == tube.v_star);
        assert_true(star.rho_left == tube.rho_star_left && star.rho_right == tube.rho_star_right);
        assert_memory_equal(star.speed, speeds, sizeof speeds);

        const int dim = 1 + count % 3;
        draw_places(n, 0, 1);
        assert_int_equal(sphproof_solutions_noh(gamma, dim, t, n, at, rho, v, P, &error),
                         SPHPROOF_OK);
        for (int i = 0; i < count; i++) {
            const struct noh_state s = noh_sample(gamma, dim, at[i], t);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
        draw_places(n, 0, 1);
        assert_null(sedov_solve(1.4, dim, 2, 0.7, &sedov));
        for (int given = 0; given < 2; given++)
            assert_int_equal(sphproof_solutions_sedov(1.4, dim, 2, 0.7, t + 0.1, n, at, rho, v, P,
                                                      given ? &shock : NULL, &error),
                             SPHPROOF_OK);
        assert_true(shock == sedov_shock(&sedov, t + 0.1));
        for (int i = 0; i < count; i++) {
            const struct sedov_state s = sedov_sample(&sedov, at[i], t + 0.1);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
        draw_places(n, 0, 0.6);
        assert_int_equal(sphproof_solutions_gresho(n, at, rho, v, P, &error), SPHPROOF_OK);
        for (int i = 0; i < count; i++) {
            const struct vortex_state s = vortex_gresho(at[i]);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
        draw_places(n, 0, 3);
        assert_int_equal(sphproof_solutions_yee(gamma, 2.5, n, at, rho, v, P, &error), SPHPROOF_OK);
        for (int i = 0; i < count; i++) {
            const struct vortex_state s = vortex_yee(at[i], 2.5, gamma);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
        const struct simple_wave wave = {gamma, 1.1, 0.3, 0.9, 0.01, 2};
        draw_places(n, -1, 1);
        assert_int_equal(
            sphproof_solutions_wave(gamma, 1.1, 0.3, 0.9, 0.01, 2, t, n, at, rho, v, P, &error),
            SPHPROOF_OK);
        for (int i = 0; i < count; i++) {
            const struct simple_wave_state s = simple_wave_sample(&wave, at[i], t);
            state_is(i, s.rho, s.v, s.P);
        }
        ends_at(n);
    }
}

TEST(refused_solutions)
{
    const double gas[3] = {1, 0, 1}, wrong[3] = {-1, 0, 1};
    const struct simple_wave wave = {1.4, 1, 0, 1, 0.1, 1};
    double *const rho = found[0], *const v = found[1], *const P = found[2];
    struct sphproof_star star;
    draw_places(PLACES, 0, 1);
#define RIEMANN(left, t)   sphproof_solutions_riemann(1.4, left, gas, 0, t, 1, at, rho, v, P, &error)
#define SEDOV(dim, t)      sphproof_solutions_sedov(1.4, dim, 1, 1, t, 1, at, rho, v, P, NULL, &error)
#define NOH(gamma, dim, t) sphproof_solutions_noh(gamma, dim, t, 1, at, rho, v, P, &error)
#define YEE(gamma, beta)   sphproof_solutions_yee(gamma, beta, 1, at, rho, v, P, &error)
#define WAVE(amplitude, t)                                                                         \
    sphproof_solutions_wave(1.4, 1, 0, 1, amplitude, 1, t, 1, at, rho, v, P, &error)
    refused(RIEMANN(wrong, 1), "must not be negative");
    refused(RIEMANN(gas, -1e-300), "t: allowed: finite, 0 or more");
    refused(RIEMANN(gas, (double)INFINITY), "t: allowed: finite, 0 or more");
    for (int k = 0; k < 2; k++)
        refused(sphproof_solutions_riemann(1.4, gas, gas, k ? (double)NAN : -(double)INFINITY, 1, 1,
                                           at, rho, v, P, &error),
                "x0: allowed: finite");
    refused(sphproof_solutions_star(1.4, wrong, gas, &star, &error), "must not be negative");
    refused(SEDOV(0, 1), "");
    refused(SEDOV(4, 1), "");
    refused(SEDOV(2, 0), "t: allowed: finite, above 0");
    refused(SEDOV(2, -1), "t: allowed: finite, above 0");
    refused(SEDOV(2, (double)INFINITY), "t: allowed: finite, above 0");
    refused(NOH(1.4, 2, (double)INFINITY), "all finite");
    refused(NOH((double)INFINITY, 2, 1), "all finite");
    refused(NOH(1, 1, 1), "gamma > 1");
    refused(NOH(1.4, 0, 1), "gamma > 1");
    refused(NOH(1.4, 4, 1), "gamma > 1");
    refused(NOH(1.4, 1, -1e-300), "gamma > 1");
    refused(YEE(1, 1), "gamma > 1");
    refused(YEE(1.4, 100), "gamma > 1");
    int empty = 0; /* widths of a vortex whose centre is just empty */
    for (double gamma = 1.125; gamma < 3; gamma += 0.125) {
        double beta = sqrt(8 * gamma / (gamma - 1) / exp(1)) * M_PI * (1 - 1e-15);
        for (int k = 0; k < 20; k++, beta = nextafter(beta, 100)) {
            if (vortex_yee(0, beta, gamma).P != 0) continue;
            refused(YEE(gamma, beta), "so small that the centre is not empty");
            empty++;
        }
    }
    assert_true(empty > 0);
    refused(WAVE(0.1, -1e-300), "t = -1e-300: allowed: from 0 to below");
    refused(WAVE(0.1, simple_wave_breaking_time(&wave)), "allowed: from 0 to below");
    refused(WAVE(7, 1), "");
    const double nowhere[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, -1e-300};
    for (int k = 0; k < 4; k++) {
        at[0] = nowhere[k];
        refused(SEDOV(2, 1), "position 0 is");
        refused(NOH(1.4, 2, 1), "allowed: finite, 0 or more");
        refused(sphproof_solutions_gresho(1, at, rho, v, P, &error), "0 or more");
        refused(YEE(1.4, 1), "0 or more");
        if (isfinite(at[0])) continue;
        refused(RIEMANN(gas, 1), "allowed: finite");
        refused(WAVE(0.1, 0), "allowed: finite");
    }
    at[0] = 0.5;
    ends_at(0);
    for (int i = 0; i < PLACES; i++) { /* any of them */
        char says[60];
        const double before = at[i];
        at[i] = -0.25 * (i + 1);
        snprintf(says, sizeof says, "position %d is %g: allowed: finite, 0 or more", i, at[i]);
        refused(sphproof_solutions_gresho(PLACES, at, rho, v, P, &error), says);
        at[i] = before;
    }
    assert_int_equal(WAVE(0.1, nextafter(simple_wave_breaking_time(&wave), 0)), SPHPROOF_OK);
    assert_int_equal(RIEMANN(gas, 0), SPHPROOF_OK);
    assert_int_equal(NOH(1.4, 1, 0), SPHPROOF_OK);
    assert_int_equal(NOH(1.4, 3, 0), SPHPROOF_OK);
}

/* ---- setups ---- */

enum { SIDE = 8, MOST = SIDE * SIDE * SIDE };
static double x[3][MOST], v[3][MOST], m[MOST], u[MOST];

/* A jittered lattice in a box with a random origin, in random order. */
static struct sphproof_setup drawn_setup(int dim)
{
    struct sphproof_setup setup = {.dim = dim, .n = 1, .m = m, .u = u, .gamma = 1.5};
    for (int a = 0; a < dim; a++) {
        setup.lo[a] = uniform(-1, 1), setup.hi[a] = setup.lo[a] + uniform(1, 1.2);
        setup.x[a] = x[a], setup.v[a] = v[a];
        setup.n *= SIDE;
    }
    for (size_t k = 0; k < setup.n; k++) {
        const size_t i = k * 27 % setup.n, cell[] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        for (int a = 0; a < dim; a++) {
            x[a][k] = setup.lo[a] +
                      ((double)cell[a] + uniform(0.4, 0.6)) / SIDE * (setup.hi[a] - setup.lo[a]);
            v[a][k] = uniform(-0.1, 0.1);
        }
        m[k] = uniform(1, 1.1) / (double)setup.n, u[k] = uniform(1, 2);
    }
    return setup;
}

static double away(const struct sphproof_setup *setup, size_t i, size_t j, int a)
{
    const double length = setup->hi[a] - setup->lo[a], d = x[a][i] - x[a][j];
    return d - length * round(d / length);
}

/* The mass and the number of particles within h, images included. */
static double sum_of(const struct sphproof_setup *setup, const struct sphproof_kernel *kernel,
                     size_t i, double h, double *number)
{
    double sum = 0;
    *number = 0;
    for (size_t j = 0; j < setup->n; j++) {
        double squares = 0;
        for (int a = 0; a < setup->dim; a++) squares += away(setup, i, j, a) * away(setup, i, j, a);
        const double r = sqrt(squares);
        sum += m[j] * sphproof_kernels_value(kernel, r, h, setup->dim);
        *number += r < h;
    }
    return sum;
}

/* At the start the rates of a setup and the state of its simulation agree with sums over pairs. */
TEST(setups)
{
    static const char *const keys[] = {"kernel=cubic_spline", "eta=1.7",
                                       "volume_element=mass", "energy=internal",
                                       "viscosity=none",      NULL},
                             *const coarse[] = {"kernel=cubic_spline",
                                                "eta=1.7",
                                                "volume_element=mass",
                                                "energy=internal",
                                                "viscosity=none",
                                                "h_tolerance=1e-2",
                                                NULL};
    static double got[12][MOST + 1];
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("cubic_spline", &kernel, NULL), SPHPROOF_OK);
    for (int dim = 1; dim <= 3; dim++)
        for (int left_out = 0; left_out < 5; left_out++) { /* 3: at rest; 4: h is coarse */
            struct sphproof_setup setup = drawn_setup(dim);
            struct sphproof_simulation *simulation;
            double force[3] = {0}, power = 0, off = 0;
            setup.keys = left_out == 4 ? coarse : keys;
            if (left_out == 3) setup.v[0] = NULL;
            for (int k = 0; k < 12; k++)
                for (int i = 0; i <= MOST; i++) got[k][i] = -77;
            const struct sphproof_rates rates = {.h = got[0],
                                                 .rho = left_out == 1 ? NULL : got[1],
                                                 .P = got[2],
                                                 .dU = got[3],
                                                 .neighbours = left_out == 2 ? NULL : got[4],
                                                 .force = {got[5], got[6], got[7]}};
            if (sphproof_rates_evaluate(&setup, &rates, &error)) fail_msg("%s", error.message);
            for (size_t i = 0; i < setup.n; i++) {
                double number;
                const double h = got[0][i], rho = sum_of(&setup, kernel, i, h, &number);
                off = fmax(off, fabs(h / (1.7 * pow(m[i] / rho, 1. / dim)) - 1));
                if (left_out == 4) continue;
                if (left_out != 1) near_relative(got[1][i], rho, 1e-11);
                if (left_out != 2) assert_true(got[4][i] == number);
                near_relative(got[2][i], 0.5 * rho * u[i], 1e-11);
                power += got[3][i];
                for (int a = 0; a < dim; a++) {
                    force[a] += got[5 + a][i];
                    power += got[5 + a][i] * (setup.v[a] ? v[a][i] : 0);
                }
            }
            assert_true(left_out == 4 ? off > 2e-13 : off < 3e-14);
            for (int k = 0; k < 12; k++)
                assert_true(got[k][setup.n] == -77 && (k < 5 + dim || got[k][0] == -77));
            for (int a = 0; a < dim && left_out < 4; a++) near_absolute(force[a], 0, 1e-13);
            near_absolute(power, 0, 1e-13);

            for (int k = 0; k < 12; k++)
                for (int i = 0; i <= MOST; i++) got[k][i] = -77;
            const struct sphproof_state wanted = {.x = {got[0], got[1], got[2]},
                                                  .v = {got[3], got[4], got[5]},
                                                  .rho = got[6],
                                                  .u = left_out == 1 ? NULL : got[7],
                                                  .P = got[8],
                                                  .h = left_out == 2 ? NULL : got[9]};
            setup.threads = left_out;
            if (sphproof_simulations_create(&setup, &simulation, &error))
                fail_msg("%s", error.message);
            assert_true(sphproof_simulations_state(simulation, &wanted) == 0);
            for (size_t i = 0; i < setup.n; i++) {
                for (int a = 0; a < dim; a++) {
                    near_relative(got[a][i], x[a][i], 1e-15);
                    near_absolute(got[3 + a][i], setup.v[a] ? v[a][i] : 0, 1e-15);
                }
                assert_true(got[6][i] > 0.5 && got[6][i] < 1.5);
                if (left_out != 1) near_relative(got[7][i], u[i], 1e-14);
                near_relative(got[8][i], 0.5 * got[6][i] * u[i], 1e-13);
                if (left_out == 2) continue;
                near_relative(got[9][i], 1.7 * pow(m[i] / got[6][i], 1. / dim), 1e-2);
            }
            for (int k = 0; k < 12; k++)
                assert_true(got[k][setup.n] == -77 &&
                            (k > 9 || k % 3 < dim || got[k][0] == -77 || k > 5));
            sphproof_simulations_free(simulation);
        }
    sphproof_kernels_free(kernel);
}

TEST(refused_setups)
{
    struct sphproof_simulation *simulation;
    for (int row = 0; row < 12; row++) {
        struct sphproof_setup setup = drawn_setup(2);
        const struct sphproof_rates none = {0};
        static const char *const narrow[] = {"kernel=cubic_spline", "eta=1.7", NULL};
        char outside[120];
        const char *says = NULL;
        setup.keys = narrow;
        if (row == 0) setup.dim = 0, says = "dim = 0: allowed: 1, 2, 3";
        if (row == 1) setup.dim = 4, says = "dim = 4: allowed: 1, 2, 3";
        if (row == 2) setup.m = NULL, says = "m and u of its particles";
        if (row == 3) setup.u = NULL, says = "m and u of its particles";
        if (row == 4) setup.x[0] = NULL, says = "in 2D needs x[0]";
        if (row == 5) setup.x[1] = NULL, says = "in 2D needs x[1]";
        if (row == 6) x[1][0] = nextafter(setup.lo[1], -2);
        if (row == 7) x[0][63] = nextafter(setup.hi[0], 3);
        if (row == 6 || row == 7) {
            const int a = row == 6, i = a ? 0 : 63;
            says = outside;
            snprintf(outside, sizeof outside,
                     "particle %d: x[%d] = %.9g: allowed: in the box, %.9g to %.9g", i, a, x[a][i],
                     setup.lo[a], setup.hi[a]);
        }
        if (row == 8) setup.boundary[0] = "fixed", says = "reflecting; fixed layers need densities";
        if (row == 9)
            setup.boundary[1] = "", says = "boundary '': allowed: periodic open reflecting";
        if (row == 10) /* the ends belong to the box */
            x[0][0] = setup.lo[0], x[0][7] = setup.hi[0], x[1][7] += 0.01;
        if (row == 11) /* positions beyond open ends are allowed */
            setup.boundary[1] = "open", x[1][0] = setup.lo[1] - 0.05;
        const enum sphproof_status status =
            sphproof_simulations_create(&setup, &simulation, &error);
        if (says) {
            refused(status, says);
            assert_null(simulation);
            refused(sphproof_rates_evaluate(&setup, &none, &error), says);
        } else if (status) {
            fail_msg("row %d: %s", row, error.message);
        }
        sphproof_simulations_free(simulation);
    }
    struct sphproof_setup setup = drawn_setup(1);
    struct settings settings;
    settings_init(&settings);
    for (int k = 0; k < SETTINGS; k++) { /* keys of runs, whatever their value is */
        char value[SETTING_TEXT_MAX], key[SETTING_TEXT_MAX + 40], says[80];
        const char *const keys[] = {key, NULL};
        if (!strcmp(setting_keys[k].section, "scheme")) continue;
        settings_text(&settings, (enum setting)k, value);
        if (settings_set(&settings, (enum setting)k, value, SOURCE_FALLBACK, NULL, NULL))
            strcpy(value, "auto");
        snprintf(key, sizeof key, "%s=%s", setting_keys[k].name, value);
        snprintf(says, sizeof says, "%s is no key of a scheme", setting_keys[k].name);
        setup.keys = keys;
        refused(sphproof_simulations_create(&setup, &simulation, &error), says);
    }
    setup.keys = NULL;
    assert_int_equal(sphproof_simulations_create(&setup, &simulation, &error), SPHPROOF_OK);
    refused(sphproof_simulations_run(simulation, 2e300, &error), "t = 2e+300: allowed: 0 or later");
    sphproof_simulations_free(simulation);
}

/* ---- gradients of a cloud ---- */

static double bump(double q, int dim)
{
    (void)dim;
    return q < 1 ? pow(1 - q * q, 3) : 0;
}

static double bump_slope(double q, int dim)
{
    (void)dim;
    return q < 1 ? -6 * q * pow(1 - q * q, 2) : 0;
}

static struct sphproof_kernel *own_kernel(int dim)
{
    const struct sphproof_shape shape = {
        .w = bump, .dw = bump_slope, .smoothness = 2, .name = "bump", .dim = dim};
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_own(&shape, &kernel, NULL), SPHPROOF_OK);
    return kernel;
}

/* The standard sum and the density, in an open and in a periodic box. */
static void clouds_are_summed(struct sphproof_kernel *kernel)
{
    static double h[MOST], volume[MOST], f[MOST], got[4][MOST + 1];
    for (int dim = 1; dim <= 3; dim++)
        for (int periodic = 0; periodic < 2; periodic++) {
            const struct sphproof_setup setup = drawn_setup(dim);
            struct sphproof_cloud cloud = {.dim = dim,
                                           .n = setup.n,
                                           .x = {x[0], x[1], x[2]},
                                           .volume = volume,
                                           .h = h,
                                           .periodic = periodic};
            double *const to[] = {got[0], got[1], got[2]};
            memcpy(cloud.lo, setup.lo, sizeof cloud.lo);
            memcpy(cloud.hi, setup.hi, sizeof cloud.hi);
            for (size_t i = 0; i < setup.n; i++)
                h[i] = uniform(0.2, 0.3), volume[i] = uniform(1, 2), f[i] = uniform(-1, 1);
            for (int k = 0; k < 4; k++)
                for (int i = 0; i <= MOST; i++) got[k][i] = -77;
            assert_int_equal(sphproof_gradients_apply("standard", kernel, &cloud, f, to, &error),
                             SPHPROOF_OK);
            for (size_t i = 0; i < setup.n; i++) {
                double sum[3] = {0};
                for (size_t j = 0; j < setup.n; j++) {
                    double d[3] = {0}, squares = 0;
                    for (int a = 0; a < dim; a++) {
                        d[a] = periodic ? away(&setup, i, j, a) : x[a][i] - x[a][j];
                        squares += d[a] * d[a];
                    }
                    const double r = sqrt(squares);
                    for (int a = 0; a < dim && j != i; a++)
                        sum[a] +=
                            volume[j] * f[j] * sphproof_kernels_dr(kernel, r, h[i], dim) * d[a] / r;
                }
                for (int a = 0; a < dim; a++) near_absolute(got[a][i], sum[a], 1e-9);
            }
            for (int k = 0; k < 4; k++)
                assert_true(got[k][setup.n] == -77 && (k < dim || got[k][0] == -77));
            cloud.volume = cloud.h = NULL;
            assert_int_equal(
                sphproof_gradients_density(kernel, 2, &cloud, m, got[0], got[1], &error),
                SPHPROOF_OK);
            for (size_t i = 0; i < setup.n && periodic; i++) {
                double number;
                near_relative(got[1][i], sum_of(&setup, kernel, i, got[0][i], &number), 1e-8);
                near_relative(got[0][i], 2 * pow(m[i] / got[1][i], 1. / dim), 1e-8);
            }
            refused(sphproof_gradients_apply("standard", kernel, &cloud, f, to, &error),
                    "volume and h");
            cloud.volume = volume;
            refused(sphproof_gradients_apply("standard", kernel, &cloud, f, to, &error),
                    "volume and h");
            cloud.h = h, cloud.volume = NULL;
            refused(sphproof_gradients_apply("standard", kernel, &cloud, f, to, &error),
                    "volume and h");
            cloud.volume = volume, cloud.x[dim - 1] = NULL;
            char says[40];
            snprintf(says, sizeof says, "%dD needs x[%d]", dim, dim - 1);
            refused(sphproof_gradients_apply("standard", kernel, &cloud, f, to, &error), says);
            cloud.dim = dim == 1 ? 0 : 4;
            refused(sphproof_gradients_density(kernel, 2, &cloud, m, got[0], got[1], &error),
                    dim == 1 ? "dim = 0: allowed" : "dim = 4: allowed");
            refused(sphproof_gradients_apply(NULL, kernel, &cloud, f, to, &error),
                    "no operator ''");
        }
    sphproof_kernels_free(kernel);
}

TEST(clouds)
{
    struct sphproof_kernel *kernel;
    assert_int_equal(sphproof_kernels_find("wendland_c4", &kernel, NULL), SPHPROOF_OK);
    clouds_are_summed(kernel);
    clouds_are_summed(own_kernel(0));
}

/* A kernel for one dimension alone is refused in the others. */
TEST(kernel_of_one_dimension)
{
    double h[1] = {1}, f[1] = {1}, volume[1] = {1},
           got[3][1], *const to[] = {got[0], got[1], got[2]};
    for (int own = 1; own <= 3; own++) {
        struct sphproof_kernel *kernel = own_kernel(own);
        for (int dim = 1; dim <= 3; dim++) {
            const struct sphproof_cloud cloud = {
                .dim = dim, .n = 1, .x = {f, f, f}, .volume = volume, .h = h};
            const enum sphproof_status sum = sphproof_gradients_apply("ia", kernel, &cloud, f, to,
                                                                      &error),
                                       density = sphproof_gradients_density(kernel, 2, &cloud, f, h,
                                                                            got[0], &error);
            char says[60];
            snprintf(says, sizeof says, "kernel bump: dim = %d is not among its own", dim);
            assert_int_equal(sum, dim == own ? SPHPROOF_OK : SPHPROOF_BAD_INPUT);
            if (dim == own)
                assert_int_equal(density, SPHPROOF_BROKE_DOWN); /* any h suits one point */
            else
                refused(density, says);
        }
        sphproof_kernels_free(kernel);
    }
}

/* ---- figures of an operator ---- */

enum { POINTS_MAX = 9000, FIGURES_MAX = 40, ETA_TENTHS = 22 };

/* A function of every input of an operator, in place of a gradient. */
static double planted(const struct sphproof_cloud *cloud, const double *f, size_t i, int a)
{
    return (a == 2 ? 10 : 1 + a) * f[i] * (1.5 + cloud->x[0][i]) + f[i] * f[i] - 0.25 * a +
           cloud->h[i] - 9 * cloud->volume[i];
}

static int calls, refuse_at; /* the call that reports failure; 0: none */

static bool plant(void *context, const struct sphproof_cloud *cloud, const double *f,
                  double *const gradient[])
{
    assert_ptr_equal(context, &calls);
    for (int a = 0; a < cloud->dim; a++)
        for (size_t i = 0; i < cloud->n; i++) gradient[a][i] = planted(cloud, f, i, a);
    return ++calls != refuse_at;
}

static struct sphproof_figure figures[FIGURES_MAX];
static char wheres[FIGURES_MAX][80];
static int seen;

static void see(void *context, const struct sphproof_figure *figure)
{
    assert_ptr_equal(context, &seen);
    assert_true(seen < FIGURES_MAX);
    snprintf(wheres[seen], sizeof wheres[seen], "%s", figure->where);
    figures[seen++] = *figure;
}

/* A cloud as the check makes it, with a field. */
struct made {
    struct clouds_settings settings;
    struct clouds_cloud cloud;
    struct sphproof_cloud given;
    size_t n;
    int dim;
    double f[POINTS_MAX], slope[3][POINTS_MAX], largest;
};

static void make(struct made *made, struct clouds_settings settings, enum gradient_function field)
{
    assert_int_equal(clouds_make(&settings, &made->cloud, NULL), STATUS_OK);
    made->settings = settings, made->dim = settings.dim, made->largest = 0;
    made->n = made->cloud.cloud.points.n;
    made->given = (struct sphproof_cloud){.h = made->cloud.h, .volume = made->cloud.volume};
    for (int a = 0; a < 3; a++) made->given.x[a] = made->cloud.x[a];
    assert_true(made->n <= POINTS_MAX);
    for (size_t i = 0; i < made->n; i++) {
        double place[3] = {0}, slope[3] = {0};
        for (int a = 0; a < made->dim; a++) place[a] = made->cloud.x[a][i];
        made->f[i] = gradient_study_field(field, made->dim, place, slope);
        for (int a = 0; a < made->dim; a++) made->slope[a][i] = slope[a];
        made->largest = fmax(made->largest, fabs(made->f[i]));
    }
}

static struct clouds_settings usual(enum clouds_kind kind, int dim)
{
    struct clouds_settings settings = gradient_study_cloud(kind, dim);
    settings.eta = ETA_TENTHS / 10.;
    return settings;
}

static int reported;

/* Compares the next figure that the check has reported. */
static void figure_is(const char *property, const char *formula, const char *where, double value,
                      double bound)
{
    assert_true(reported < seen);
    const struct sphproof_figure *figure = &figures[reported];
    assert_string_equal(figure->property, property);
    assert_non_null(strstr(figure->formula, formula));
    assert_string_equal(wheres[reported++], where);
    near_relative(figure->value + 1, value + 1, 1e-10);
    if (value > 0) near_relative(figure->value, value, 1e-6);
    assert_true(figure->bound == bound && figure->floor == 1e-14 && !figure->skipped);
    assert_true(figure->passed == (figure->value <= figure->bound));
}

static double misses[3][POINTS_MAX];

/* The largest |misses| h of points whose support lies inside, over the largest |f|. */
static double worst(const struct made *made, double stretch)
{
    double most = 0;
    for (size_t i = 0; i < made->n; i++)
        for (int a = 0; a < made->dim; a++)
            if (clouds_interior(&made->settings, &made->cloud, i))
                most = fmax(most, fabs(misses[a][i]) * stretch * made->cloud.h[i] / made->largest);
    return most;
}

static struct made one;

static void fields_are(int dim, bool linear)
{
    static double other[POINTS_MAX], both[POINTS_MAX];
    char where[80];
    make(&one, usual(CLOUDS_SOBOL, dim), FUNCTION_SMOOTH);
    for (size_t i = 0; i < one.n; i++) {
        other[i] = cos(3 * one.f[i]);
        both[i] = 2.385 * one.f[i] - 0.71 * other[i];
    }
    snprintf(where, sizeof where, "%dD, %s", dim, clouds_name(CLOUDS_SOBOL));
    figure_is("repeats", "same input", where, 0, 0);
    for (int a = 0; a < dim; a++)
        for (size_t i = 0; i < one.n; i++)
            misses[a][i] = planted(&one.given, both, i, a) -
                           2.385 * planted(&one.given, one.f, i, a) +
                           0.71 * planted(&one.given, other, i, a);
    if (linear) figure_is("linear", "grad (a f + b g)", where, worst(&one, 1), 1e-9);
    clouds_free(&one.cloud);
}

static void exactness_is(int dim, int degrees)
{
    char where[80];
    for (int degree = 0; degree < degrees; degree++)
        for (int kind = 0; kind < CLOUDS_KINDS; kind++) {
            const enum gradient_function field = degree ? FUNCTION_LINEAR : FUNCTION_CONSTANT;
            make(&one, usual((enum clouds_kind)kind, dim), field);
            snprintf(where, sizeof where, "%dD, %s, %s field", dim,
                     clouds_name((enum clouds_kind)kind), gradient_study_field_name(field));
            for (int a = 0; a < dim; a++)
                for (size_t i = 0; i < one.n; i++)
                    misses[a][i] = planted(&one.given, one.f, i, a) - one.slope[a][i];
            figure_is("exactness", "of polynomials", where, worst(&one, 1), 1e-9);
            clouds_free(&one.cloud);
        }
}

/* The cloud is rotated by R, or scaled, and shifted; the gradient transforms with it. */
static void move_is(int dim, const char *property, const char *formula, const double R[9],
                    double unit, const double shift[3])
{
    static double moved[3][POINTS_MAX], h[POINTS_MAX], volume[POINTS_MAX];
    const struct sphproof_cloud there = {
        .x = {moved[0], moved[1], moved[2]}, .h = h, .volume = volume};
    char where[80];
    make(&one, usual(CLOUDS_CLUSTERED, dim), FUNCTION_SMOOTH);
    for (size_t i = 0; i < one.n; i++) {
        h[i] = unit * one.cloud.h[i], volume[i] = pow(unit, dim) * one.cloud.volume[i];
        for (int a = 0; a < dim; a++) {
            moved[a][i] = shift[a];
            for (int b = 0; b < dim; b++) moved[a][i] += unit * R[a * dim + b] * one.cloud.x[b][i];
        }
    }
    snprintf(where, sizeof where, "%dD, %s", dim, clouds_name(CLOUDS_CLUSTERED));
    for (int a = 0; a < dim; a++)
        for (size_t i = 0; i < one.n; i++) {
            misses[a][i] = planted(&there, one.f, i, a);
            for (int b = 0; b < dim; b++)
                misses[a][i] -= R[a * dim + b] / unit * planted(&one.given, one.f, i, b);
        }
    figure_is(property, formula, where, worst(&one, unit), 1e-9);
    clouds_free(&one.cloud);
}

static void moves_are(int dim, const struct sphproof_gradient_promise *promise)
{
    static const double nowhere[3] = {0}, shift[3] = {3.7, -5.1, 2.3};
    const double c = cos(0.7), s = sin(0.7), e = cos(1.9), t = sin(1.9);
    const double about_z[9] = {c, -s, 0, s, c, 0, 0, 0, 1},
                 about_x[9] = {1, 0, 0, 0, e, -t, 0, t, e};
    double R[9] = {0}, unit[9] = {0};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int k = 0; k < 3; k++) R[3 * a + b] += about_z[3 * a + k] * about_x[3 * k + b];
    if (dim == 2) R[0] = R[3] = c, R[1] = -s, R[2] = s;
    if (dim == 1) R[0] = -1;
    for (int a = 0; a < dim; a++) unit[a * dim + a] = 1;
    if (promise->turns) move_is(dim, "turns", "turned gradient", R, 1, nowhere);
    if (promise->moves) move_is(dim, "moves", "shifted cloud is the same", unit, 1, shift);
    if (promise->scales) move_is(dim, "scales", "larger cloud is smaller", unit, 2.385, nowhere);
}

static void order_is(int dim, double promised)
{
    static const size_t sides[3][5] = {
        {32, 48, 72, 108, 162}, {12, 17, 24, 34, 48}, {10, 12, 14, 17, 20}};
    double spacing[5], errors[5];
    struct order_fit fit;
    char where[80];
    for (int l = 0; l < 5; l++) {
        double squares = 0, count = 0;
        for (unsigned long k = 0; k < 2; k++) {
            make(&one,
                 (struct clouds_settings){CLOUDS_JITTERED, dim, sides[dim - 1][l], 0.2,
                                          ETA_TENTHS / 10., 5 + 3 * k},
                 FUNCTION_SMOOTH);
            for (size_t i = 0; i < one.n; i++)
                for (int a = 0; a < dim; a++) {
                    if (!clouds_interior(&one.settings, &one.cloud, i)) continue;
                    const double off = planted(&one.given, one.f, i, a) - one.slope[a][i];
                    squares += off * off, count++;
                }
            clouds_free(&one.cloud);
        }
        spacing[l] = 1. / (double)sides[dim - 1][l];
        errors[l] = sqrt(squares / count);
    }
    assert_int_equal(order_fit(5, spacing, errors, NULL, &fit, NULL), STATUS_OK);
    snprintf(where, sizeof where, "%dD, jittered: %s", dim, order_class_name(fit.class));
    figure_is("order", "promised - observed", where, promised - fit.order, 0.2);
}

TEST(figures_of_an_operator)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int kept = dim == 3; kept < (dim == 3 ? 2 : 6); kept++) {
            const struct sphproof_gradient_promise promise = {.exact = kept < 3 ? 2 - kept : 2,
                                                              .order = 1.5,
                                                              .eta = ETA_TENTHS / 10.,
                                                              .turns = kept != 2,
                                                              .moves = kept != 3,
                                                              .scales = kept != 4,
                                                              .linear = kept != 5};
            calls = seen = reported = 0;
            assert_int_equal(
                sphproof_gradients_check(plant, &calls, dim, &promise, see, &seen, &error),
                SPHPROOF_CHECK_FAILED);
            fields_are(dim, promise.linear);
            exactness_is(dim, promise.exact);
            moves_are(dim, &promise);
            order_is(dim, promise.order);
            assert_int_equal(reported, seen);
            assert_int_equal(calls, 4 + promise.exact * CLOUDS_KINDS + 10 +
                                        2 * (promise.turns + promise.moves + promise.scales));
        }
}

/* The exact gradients of constants, until one call reports failure. */
static bool zero(void *context, const struct sphproof_cloud *cloud, const double *f,
                 double *const gradient[])
{
    (void)context, (void)f;
    for (int a = 0; a < cloud->dim; a++)
        for (size_t i = 0; i < cloud->n; i++) gradient[a][i] = 0;
    return ++calls != refuse_at;
}

/* Changes the last number of all at the second call. */
static bool change(void *context, const struct sphproof_cloud *cloud, const double *f,
                   double *const gradient[])
{
    (void)context, (void)f;
    for (int a = 0; a < cloud->dim; a++)
        for (size_t i = 0; i < cloud->n; i++) gradient[a][i] = 0;
    gradient[cloud->dim - 1][cloud->n - 1] = ++calls == 2;
    return true;
}

TEST(gradients_that_change)
{
    const struct sphproof_gradient_promise none = {0, -9, 2.4, true, true, true, true};
    for (int dim = 1; dim <= 2; dim++) {
        calls = 0;
        assert_int_equal(sphproof_gradients_check(change, NULL, dim, &none, NULL, NULL, &error),
                         SPHPROOF_CHECK_FAILED);
        assert_non_null(strstr(error.message, "repeats: 1, allowed 0 ("));
    }
}

/* Knows the gradient of the smooth field. */
static bool know(void *context, const struct sphproof_cloud *cloud, const double *f,
                 double *const gradient[])
{
    (void)context, (void)f;
    for (size_t i = 0; i < cloud->n; i++) {
        double place[3] = {0}, slope[3];
        for (int a = 0; a < cloud->dim; a++) place[a] = cloud->x[a][i];
        gradient_study_field(FUNCTION_SMOOTH, cloud->dim, place, slope);
        for (int a = 0; a < cloud->dim; a++) gradient[a][i] = slope[a];
    }
    return true;
}

/* Without errors there is no order. */
TEST(gradients_without_error)
{
    const struct sphproof_gradient_promise smooth = {0, 2, 2.4, false, false, false, false};
    for (int dim = 1; dim <= 2; dim++) {
        seen = 0;
        assert_int_equal(sphproof_gradients_check(know, NULL, dim, &smooth, see, &seen, &error),
                         SPHPROOF_CHECK_FAILED);
        assert_int_equal(seen, 2);
        assert_true(isnan(figures[1].value));
    }
}

/* Fills the gradient of the first point alone. */
static bool forget(void *context, const struct sphproof_cloud *cloud, const double *f,
                   double *const gradient[])
{
    (void)context, (void)f;
    for (int a = 0; a < cloud->dim; a++) gradient[a][0] = 0;
    return !refuse_at;
}

TEST(gradients_left_out)
{
    const struct sphproof_gradient_promise none = {0, -9, 2.4, true, true, true, true};
    for (refuse_at = 0; refuse_at < 2; refuse_at++) {
        assert_int_equal(sphproof_gradients_check(forget, NULL, 2, &none, NULL, NULL, &error),
                         SPHPROOF_CHECK_FAILED);
        assert_non_null(strstr(error.message, "linear: nan"));
    }
    refuse_at = 0;
}

/* What an operator is given: at the fifth call a cloud, at the sixth the same one after a move. */
static double given_x[3][POINTS_MAX], given_h[POINTS_MAX], given_volume[POINTS_MAX], by_unit;

static double distance(double *const place[], int dim, size_t i, size_t j)
{
    double square = 0;
    for (int a = 0; a < dim; a++)
        square += (place[a][i] - place[a][j]) * (place[a][i] - place[a][j]);
    return sqrt(square);
}

static bool watch(void *context, const struct sphproof_cloud *cloud, const double *f,
                  double *const gradient[])
{
    double *const before[3] = {given_x[0], given_x[1], given_x[2]};
    double *now[3];
    (void)context, (void)f;
    calls++;
    for (int a = 0; a < cloud->dim; a++) {
        now[a] = (double *)cloud->x[a];
        for (size_t i = 0; i < cloud->n; i++) assert_true(isnan(gradient[a][i]));
    }
    for (size_t i = 0; i < cloud->n && calls == 5; i++) {
        given_h[i] = cloud->h[i], given_volume[i] = cloud->volume[i];
        for (int a = 0; a < cloud->dim; a++) given_x[a][i] = cloud->x[a][i];
    }
    for (size_t i = 0; i < cloud->n && calls == 6; i++) {
        const size_t j = (i + cloud->n / 2) % cloud->n;
        assert_true(fabs(cloud->h[i] / (by_unit * given_h[i]) - 1) < 1e-15);
        assert_true(fabs(cloud->volume[i] / (pow(by_unit, cloud->dim) * given_volume[i]) - 1) <
                    1e-14);
        assert_true(fabs(distance(now, cloud->dim, i, j) -
                         by_unit * distance(before, cloud->dim, i, j)) < 1e-13);
    }
    for (int a = 0; a < cloud->dim; a++)
        for (size_t i = 0; i < cloud->n; i++) gradient[a][i] = 0;
    return true;
}

/* All points move, and turns and shifts keep their distances. */
TEST(gradients_of_moved_clouds)
{
    for (int dim = 1; dim <= 3; dim++)
        for (int move = 0; move < 3; move++) {
            const struct sphproof_gradient_promise promise = {
                .order = -9, .eta = 2.4, .turns = !move, .moves = move == 1, .scales = move == 2};
            by_unit = promise.scales ? 2.385 : 1;
            calls = 0;
            assert_int_equal(
                sphproof_gradients_check(watch, NULL, dim, &promise, NULL, NULL, &error),
                SPHPROOF_OK);
        }
}

TEST(promises)
{
    const struct sphproof_gradient_promise none = {0, -9, 2.4, true, true, true, true};
    static const struct {
        int dim, exact;
        double order, eta;
        const char *says; /* NULL: accepted */
    } rows[] = {{1, 0, -9, 2.4, NULL},
                {3, 0, -9, 1, NULL},
                {1, 1, -9, 6, NULL},
                {0, 0, -9, 2.4, "an operator and dim"},
                {4, 0, -9, 2.4, "an operator and dim"},
                {1, 0, -9, 0.9999999, "promise: allowed"},
                {1, 0, -9, 6.0000001, "promise: allowed"},
                {1, -1, -9, 2.4, "promise: allowed"},
                {1, 3, -9, 2.4, "promise: allowed"},
                {1, 0, (double)NAN, 2.4, "promise: allowed"},
                {1, 0, -HUGE_VAL, 2.4, "promise: allowed"}};
    refuse_at = 0;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct sphproof_gradient_promise promise = none;
        promise.exact = rows[k].exact, promise.order = rows[k].order, promise.eta = rows[k].eta;
        const enum sphproof_status status =
            sphproof_gradients_check(zero, NULL, rows[k].dim, &promise, NULL, NULL, &error);
        if (rows[k].says)
            refused(status, rows[k].says);
        else if (status)
            fail_msg("row %zu: %s", k, error.message);
    }
    refused(sphproof_gradients_check(NULL, NULL, 1, &none, NULL, NULL, &error), "an operator and");
    for (refuse_at = 1; refuse_at <= 20; refuse_at++) { /* any of the calls fails */
        calls = 0;
        const enum sphproof_status status =
            sphproof_gradients_check(zero, NULL, 1, &none, NULL, NULL, &error);
        assert_int_equal(calls, 20);
        assert_int_equal(status, SPHPROOF_CHECK_FAILED);
        assert_string_equal(error.message, "the operator says that it could not");
    }
    refuse_at = 0;
}
