/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests exact solutions at single positions, on their boundaries and at their limits: vortices, the
 * spinning disc, Noh's collision, Sedov's blast, the layers of McNally, Lyra & Passy, and base
 * states of layers. (The checks `exact` test their equations.) */
#include "test.h"

#include <float.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>

#include "disc.h"
#include "kelvin_helmholtz.h"
#include "layer.h"
#include "noh.h"
#include "sedov.h"
#include "vortex.h"

TEST(all_vortices)
{
    const struct {
        double R, v, P;
    } rows[] = {
        {0, 0, 5},
        {0.1, 0.5, 5.125},
        {0.2, 1, 5.5},
        {0.2 * (1 + 5e-7), 1 - 5e-7, 9 + 12.5 * 0.04 * (1 + 1e-6) - 4 * (1 + 5e-7) + 4 * 5e-7},
        {0.25, 0.75, 9 + 0.78125 - 5 + 4 * 0.22314355131420976},
        {0.3, 0.5, 9 + 1.125 - 6 + 4 * 0.4054651081081644},
        {0.4, 0, 3 + 4 * 0.6931471805599453},
        {0.4 * (1 + 5e-7), 0, 3 + 4 * 0.6931471805599453},
        {7, 0, 3 + 4 * 0.6931471805599453},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const struct vortex_state s = vortex_gresho(rows[k].R);
        near_absolute(s.v - rows[k].v, 0, 1e-12);
        near_relative(s.P, rows[k].P, 1e-12);
        assert_true(s.rho == 1);
    }
    for (int i = 0; i < 20; i++) {
        const double R = 0.15 * i, beta = 5 - 0.1 * i, gamma = 1.1 + 0.1 * i;
        const struct vortex_state s = vortex_yee(R, beta, gamma);
        const double T = 1 - (gamma - 1) * beta * beta / (8 * gamma * M_PI * M_PI) * exp(1 - R * R);
        near_relative(s.rho, pow(T, 1 / (gamma - 1)), 1e-12);
        near_relative(s.P, pow(s.rho, gamma), 1e-12);
        near_absolute(s.v - beta * R / (2 * M_PI) * exp(0.5 * (1 - R * R)), 0, 1e-14);
    }
}

TEST(discs)
{
    /* spin 2 and P = 3/2: a^2 = 1 + 7 t^2 */
    assert_true(disc_radius(2, 1.5, 0) == 1);
    near_relative(disc_radius(2, 1.5, 3), 8, 1e-15);
    for (int i = 0; i <= 10; i++) {
        const double r = 0.9 * i;
        const struct disc_state s = disc_sample(2, 1.5, r, 3);
        near_absolute(s.rho - (r <= 8 ? 1. / 64 : 0), 0, 1e-16);
        near_absolute(s.P - (r <= 8 ? 1.5 * (1 - r * r / 64) / 4096 : 0), 0, 1e-17);
        near_absolute(s.v_out - 21 * r / 64, 0, 1e-14);
        near_absolute(s.v_along - 2 * r / 64, 0, 1e-14);
    }
    assert_true(disc_sample(2, 1.5, 1, 0).rho == 1); /* the edge belongs to the disc */
    assert_true(disc_sample(2, 1.5, nextafter(1, 2), 0).rho == 0);
}

TEST(noh_in_all_dimensions)
{
    for (int d = 1; d <= 3; d++) {
        struct noh_state s = noh_sample(3, d, nextafter(0.25, 0), 0.25); /* gamma = 3: R = t */
        assert_true(s.rho == pow(2, d) && s.v == 0 && s.P == s.rho);
        s = noh_sample(3, d, 0.25, 0.25); /* the shock itself has the state ahead of it */
        assert_true(s.rho == pow(2, d - 1) && s.v == -1 && s.P == 0);
        s = noh_sample(1.5, d, 0.5, 1);
        near_relative(s.rho, pow(3, d - 1), 1e-15);
        s = noh_sample(1.5, d, 0.125, 1);
        near_relative(s.rho, pow(5, d), 1e-15);
        near_relative(s.P, 0.25 * pow(5, d), 1e-15);
        s = noh_sample(1.5, d, 0, 0);
        assert_true(s.rho == 1 && s.v == 0 && s.P == 0);
        s = noh_sample(1.5, d, 1e-7, 0);
        assert_true(s.rho == 1 && s.v == -1 && s.P == 0);
    }
    assert_true(noh_shock(1.5, 3) == 0.75);
}

/* ---- Sedov's blast ---- */

TEST(sedov_limits)
{
    static const double nan = (double)NAN;
    static const struct {
        double gamma, rho, E;
        int d;
        const char *fault; /* NULL: none */
    } rows[] = {
        {1.4, 1, 1, 0, "d must be 1, 2 or 3"},
        {1.4, 1, 1, 4, "d must be 1, 2 or 3"},
        {1.4, 0, 1, 3, "rho must be finite and above 0"},
        {1.4, nan, 1, 3, "rho must be finite and above 0"},
        {1.4, HUGE_VAL, 1, 3, "rho must be finite and above 0"},
        {1.4, 1, 0, 3, "E must be finite and above 0"},
        {1.4, 1, nan, 3, "E must be finite and above 0"},
        {1.4, 1, HUGE_VAL, 3, "E must be finite and above 0"},
        {1, 1, 1, 3, "gamma must be above 1 and below 7"},
        {nan, 1, 1, 3, "gamma must be above 1 and below 7"},
        {7, 1, 1, 3, "gamma must be above 1 and below 7"},
        {100, 1, 1, 2, "gamma must be above 1 and below 7"},
        {2, 1, 1, 3, "gamma must be no nearer to 2 than 1e-3"},
        {2.00099, 1, 1, 3, "gamma must be no nearer to 2 than 1e-3"},
        {1.99901, 1, 1, 3, "gamma must be no nearer to 2 than 1e-3"},
        {2.001001, 1, 1, 3, NULL},
        {1.99899, 1, 1, 1, NULL},
        {6.5, 1, 1, 3, NULL},
        {7.5, 1, 1, 2, NULL},
        {99.5, 1, 1, 1, NULL},
        {1.4, 1e-9, 1e-9, 1, NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct sedov s = {.d = 42};
        const char *fault = sedov_solve(rows[k].gamma, rows[k].d, rows[k].rho, rows[k].E, &s);
        if (!rows[k].fault) {
            assert_null(fault);
            assert_true(s.d == rows[k].d && s.gamma == rows[k].gamma && s.rho == rows[k].rho &&
                        s.E == rows[k].E);
            continue;
        }
        assert_string_equal(fault, rows[k].fault);
        assert_int_equal(s.d, 42);
    }
}

static double way_of(double r, const struct sedov_state *s)
{
    return s->rho * r;
}

static void other_handler(const char *reason, const char *file, int line, int number)
{
    (void)reason, (void)file, (void)line, (void)number;
}

/* The integrand may depend on the position. GSL's error handler is restored. */
TEST(integral_of_sedov)
{
    struct sedov s;
    gsl_error_handler_t *const before = gsl_set_error_handler(other_handler);
    assert_null(sedov_solve(1.4, 3, 2, 3, &s));
    const double t = 0.7, R = sedov_shock(&s, t);
    near_relative(sedov_integral(&s, 2 * R, t, way_of) - sedov_integral(&s, R, t, way_of),
                  30 * M_PI * pow(R, 4), 1e-9);
    assert_true(gsl_set_error_handler(before) == other_handler);
}

/* At the shock the jump of a strong shock; ahead of it the undisturbed gas; in the middle no
 * density and a pressure that is constant below 1e-12 of the radius. */
TEST(sedov_ends)
{
    for (int d = 1; d <= 3; d++) {
        struct sedov s;
        assert_null(sedov_solve(1.4, d, 2, 3, &s));
        const double t = 0.7, R = sedov_shock(&s, t), D = 2 * R / ((d + 2) * t);
        near_relative(R, s.xi0 * pow(3 * t * t / 2, 1. / (d + 2)), 1e-14);
        struct sedov_state at = sedov_sample(&s, R, t);
        assert_true(at.rho == 2 && at.v == 0 && at.P == 0);
        at = sedov_sample(&s, R * (1 - 1e-13), t);
        near_relative(at.rho, 12, 1e-10);
        near_relative(at.v, D / 1.2, 1e-10);
        near_relative(at.P, 2 * D * D / 1.2, 1e-10);
        at = sedov_sample(&s, nextafter(R, 0), t);
        near_relative(at.rho, 12, 1e-10);
        near_relative(at.v, D / 1.2, 1e-10);
        near_relative(at.P, 2 * D * D / 1.2, 1e-10);
        at = sedov_sample(&s, 1e-9 * R, t);
        const struct sedov_state inner = sedov_sample(&s, 1e-10 * R, t);
        near_relative(at.P, inner.P, 1e-6);
        near_relative(inner.rho / at.rho, pow(10, -d / 0.4), 1e-5); /* rho ~ r^(d/(gamma - 1)) */
        near_relative(at.v, 1e-9 * R / (1.4 * t) * 2 / (d + 2), 1e-6);
        at = sedov_sample(&s, 0, t);
        assert_true(at.rho < inner.rho);
        const struct sedov_state held = sedov_sample(&s, 1e-12 * R, t);
        near_relative(at.rho, held.rho, 1e-3);
        near_relative(held.rho / sedov_sample(&s, 1e-11 * R, t).rho, pow(10, -d / 0.4), 1e-3);
        near_relative(at.P, inner.P, 1e-6);
    }
}

/* rho/rho_0, v/D and P/(rho_0 D^2) at r/R: the equations of motion, integrated inwards from the
 * shock by Taylor's series in multiple precision. */
TEST(sedov_inside)
{
    static const struct {
        double gamma;
        int d;
        double at, rho, v, P;
    } rows[] = {
        {1.4, 1, 0.96875, 4.78793902282668656, 0.79489906735895347, 0.729943797943545692},
        {1.4, 1, 0.5, 0.403101274586509553, 0.360238138915129419, 0.337430236898939266},
        {1.4, 2, 0.96875, 3.97364615763691002, 0.787270751540889739, 0.669952469807951844},
        {1.4, 2, 0.75, 0.52801412764460614, 0.548839870594256522, 0.348226686818212051},
        {1.4, 3, 0.75, 0.229282958575366072, 0.541939045641013533, 0.32154562229128385},
        {1.4, 3, 0.5, 0.0103111375638722958, 0.35723087797566115, 0.30489853549206794},
        {5. / 3, 1, 0.75, 1.49731761967294635, 0.498359948050273547, 0.387011736063204951},
        {5. / 3, 2, 0.5, 0.189656627833413851, 0.302753541479411006, 0.24905431779044503},
        {5. / 3, 3, 0.96875, 2.80091871584572847, 0.704487577597636138, 0.596169067636639046},
        {3, 1, 0.5, 0.9467206861748081, 0.185871819101358684, 0.178326896497169725},
        {3, 2, 0.96875, 1.8492704726979534, 0.476631172930159544, 0.448331436608065142},
        {3, 3, 0.75, 0.825683885252354543, 0.318641869917509801, 0.17560914156180493},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        struct sedov s;
        assert_null(sedov_solve(rows[k].gamma, rows[k].d, 2, 3, &s));
        const double t = 0.7, R = sedov_shock(&s, t), D = 2 * R / ((rows[k].d + 2) * t);
        const struct sedov_state at = sedov_sample(&s, rows[k].at * R, t);
        near_relative(at.rho, 2 * rows[k].rho, 1e-12);
        near_relative(at.v, D * rows[k].v, 1e-12);
        near_relative(at.P, 2 * D * D * rows[k].P, 1e-12);
    }
}

/* The search ends at every position of every blast, and finds no gas denser than that behind the
 * shock. */
TEST(sedov_of_any_blast)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < 3000; i++) {
        double u[4];
        for (int k = 0; k < 4; k++) u[k] = gsl_rng_uniform(random);
        const int d = 1 + i % 3;
        const struct sedov s = {1 + pow(10, (d == 3 ? 8.7 : 9.9) * u[0] - 8),
                                pow(10, 200 * u[1] - 100), pow(10, 200 * u[2] - 100), d, 1};
        const double part = i % 7 == 0   ? 1 - pow(10, -16 * u[3])
                            : i % 7 == 1 ? pow(10, -320 * u[3])
                                         : u[3];
        const double t = i % 5 ? 0.7 : pow(10, 200 * u[3] - 100), R = sedov_shock(&s, t);
        const struct sedov_state at = sedov_sample(&s, part * R, t);
        near_below(at.rho / s.rho, (s.gamma + 1) / (s.gamma - 1) * (1 + 1e-7));
        assert_true(at.rho >= 0 && at.v >= 0 && at.P >= 0);
    }
    gsl_rng_free(random);
}

/* ---- layers ---- */

TEST(layers_of_mcnally)
{
    for (int i = 0; i <= 103; i++) { /* exactly where layers join, and right behind */
        const double y = i <= 100 ? i / 100. : 0.25 * (i - 100) * (1 + 9e-7), x = 0.013 * i;
        const double from = fabs(y - (y < 0.5 ? 0.25 : 0.75)), fall = 0.5 * exp(-from / 0.025);
        const double step = y > 0.25 && y < 0.75 ? 1 - fall : y == 0.25 || y == 0.75 ? 0.5 : fall;
        const struct kelvin_helmholtz_state s = kelvin_helmholtz_start(x, y);
        near_relative(s.rho, 1 + step, 1e-12);
        near_absolute(s.v[0] - (0.5 - step), 0, 1e-12);
        near_absolute(s.v[1] - 0.01 * sin(4 * M_PI * x), 0, 1e-15);
        assert_true(s.P == 2.5);
    }
    enum { N = 7 }; /* arrays have one more element, which must not count */
    const double x[] = {0.1, 0.23, 0.37, 0.52, 0.68, 0.77, 0.95, 0.4},
                 y[] = {0.2, 0.3, 0.55, 0.8, 0.4, 0.5 + 2e-7, 0.26, 0.5},
                 v[] = {1, -2, 3, 1.5, -1, 0.5, 2, 9}, w[] = {1, 2, 1.5, 0.5, 3, 100, 2, 9};
    double a = 0, b = 0, c = 0;
    for (int i = 0; i < N; i++) {
        const double E = w[i] * exp(-4 * M_PI * fmin(fabs(y[i] - 0.25), fabs(y[i] - 0.75)));
        a += v[i] * sin(4 * M_PI * x[i]) * E;
        b += v[i] * cos(4 * M_PI * x[i]) * E;
        c += E;
    }
    near_relative(kelvin_helmholtz_amplitude(N, x, y, v, w), 2 * sqrt(a * a + b * b) / c, 1e-13);
}

TEST(table_of_mcnally)
{
    static const struct {
        double t, M;
    } rows[] = {
        {0, 1e-2},
        {0.7, 1.935984506048611e-2},
        {1.5, 1.479463247047325e-1},
        /* natural cubic splines of ln M, computed in multiple precision */
        {0.05, 0.00950626600005055141},
        {0.333, 0.00825700128086381176},
        {0.77, 0.0242911217036157891},
        {1.48, 0.142943838133652391},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        near_relative(kelvin_helmholtz_reference(rows[k].t), rows[k].M, 1e-13);
    assert_true(isnan(kelvin_helmholtz_reference(nextafter(1.5, 2))));
    assert_true(isnan(kelvin_helmholtz_reference(-DBL_TRUE_MIN)));
    assert_true(isnan(kelvin_helmholtz_reference((double)NAN)));
}

static const struct layer shear = {1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false},
                          heavy = {1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0.3, false, 0.6, false};

TEST(layer_faults)
{
    static const char four[] = "gamma > 1, k > 0, width > 0 and P > 0 are needed",
                      density[] = "density has to be positive everywhere",
                      strong[] = "gravity is too strong: pressure has to be positive everywhere";
    static const struct {
        struct layer layer;
        const char *fault;
    } rows[] = {
        {{1, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false}, four},
        {{1.0000001, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false}, NULL},
        {{1.4, 0, 0.07, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false}, four},
        {{1.4, 3, 0, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false}, four},
        {{1.4, 3, 0.07, 1.3, 0.2, 0.4, 0, 0, true, 0, false}, four},
        {{1.4, 3, 0.07, 1.3, -1.3, 0.4, 1.7, 0, true, 0, false}, density},
        {{1.4, 3, 0.07, 1.3, 1.3, 0.4, 1.7, 0, true, 0, false}, density},
        {{1.4, 3, 0.07, 1.3, -1.29, 0.4, 1.7, 0, true, 0, false}, NULL},
        {{1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 1e-9, true, 0, false}, "gravity needs walls"},
        {{1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, false, 0, false},
         "walls at y = -wall and wall > 0 are needed"},
        {{1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, false, 1e-9, false}, NULL},
        /* P = 1 - y, or 1 + y: 0 at a wall */
        {{1.4, 3, 0.07, 1, 0, 0, 1, 1, false, 1, false}, strong},
        {{1.4, 3, 0.07, 1, 0, 0, 1, -1, false, 1, false}, strong},
        {{1.4, 3, 0.07, 1, 0, 0, 1, 0.999, false, 1, false}, NULL},
        {{1.4, 3, 0.07, 1, 0, 0, 1, -0.999, false, 1, false}, NULL},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const char *fault = layer_fault(&rows[k].layer);
        if (rows[k].fault)
            assert_string_equal(fault, rows[k].fault);
        else
            assert_null(fault);
    }
}

TEST(layer_bases)
{
    for (int i = -50; i <= 50; i++) {
        const double y = 0.012 * i;
        struct layer_base b = layer_base(&heavy, y);
        const double T = 1 - 2 / (exp(2 * y / 0.07) + 1), slope = (1 - T * T) / 0.07;
        near_relative(b.rho, 1.3 + 0.2 * T, 1e-13);
        near_absolute(b.U - 0.4 * T, 0, 1e-13);
        near_absolute(b.rho_dy - 0.2 * slope, 0, 1e-12);
        near_absolute(b.U_dy - 0.4 * slope, 0, 1e-12);
        near_relative(b.P, 1.7 - 0.3 * (1.3 * y + 0.2 * 0.07 * log(cosh(y / 0.07))), 1e-13);
        near_relative(b.c2, 1.4 * b.P / b.rho, 1e-14);
        b = layer_base(&shear, y);
        const double z = sin(2 * M_PI * y) / (2 * M_PI * 0.07), S = 1 - 2 / (exp(2 * z) + 1);
        near_relative(b.rho, 1.3 + 0.2 * S, 1e-13);
        near_absolute(b.rho_dy - 0.2 * (1 - S * S) * cos(2 * M_PI * y) / 0.07, 0, 1e-12);
        near_absolute(b.U_dy - 0.4 * (1 - S * S) * cos(2 * M_PI * y) / 0.07, 0, 1e-12);
        near_absolute(b.U - 0.4 * S, 0, 1e-13);
        assert_true(b.P == 1.7);
        near_relative(b.c2, 1.4 * 1.7 / b.rho, 1e-14);
    }
    /* far out, where cosh overflows: P = P0 - g (rho y + step (|y| - width ln 2)) */
    struct layer far = heavy;
    far.g = 1e-4;
    near_relative(layer_base(&far, 100).P, 1.7 - 1e-4 * (130 + 0.2 * (100 - 0.07 * M_LN2)), 1e-14);
    near_relative(layer_base(&far, -100).P, 1.7 - 1e-4 * (-130 + 0.2 * (100 - 0.07 * M_LN2)),
                  1e-14);
}
