/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the simple wave at its limits: when it breaks, refused input, numbers beyond the range of
 * double. (The check `exact simple_wave` tests its start and its equations.) */
#include "test.h"

#include <float.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_roots.h>

#include "simple_wave.h"

static const struct simple_wave wave = {5. / 3, 2.385, -0.3, 0.7, 0.25, 1.7};

static double sound(const struct simple_wave *w)
{
    return sqrt(w->gamma * w->P0 / w->rho0);
}

TEST(time_of_breaking)
{
    /* gamma = 3: v + c = v0 + c0 + 2 c0 A sin, so t = L/(4 pi c0 A) */
    const struct simple_wave linear = {3, 1, 0, 1. / 3, 0.4, 2};
    near_relative(simple_wave_breaking_time(&linear), 2 / (4 * M_PI * 0.4), 1e-15);
    const double end = simple_wave_breaking_time(&wave);
    assert_true(isfinite(simple_wave_sample(&wave, 0.3, end * (1 - 1e-12)).rho));
    assert_true(isnan(simple_wave_sample(&wave, 0.3, end).rho));
    assert_true(isnan(simple_wave_sample(&wave, 0.3, -1).u));
    assert_true(isnan(simple_wave_sample(&wave, (double)NAN, 0).v));
    struct simple_wave flat = wave;
    flat.amplitude = 0;
    assert_true(isinf(simple_wave_breaking_time(&flat)));
    near_relative(simple_wave_sample(&flat, 0.3, 1e6).rho, 2.385, 1e-15);
}

/* The breaking time at the steepest position: 1/t is the largest value of (gamma + 1)/2 c0 k A (1 +
 * A s)^((gamma - 3)/2) sqrt(1 - s^2). */
TEST(breaking_times)
{
    static const double gammas[] = {1.1, 1.4, 2.2, 3, 5}, amplitudes[] = {1e-3, 0.25, -0.6, 0.95};
    for (int k = 0; k < 20; k++) {
        const double gamma = gammas[k % 5], A = fabs(amplitudes[k / 5]),
                     golden = 0.6180339887498949;
        const struct simple_wave w = {gamma, 2.385, -0.3, 0.7, amplitudes[k / 5], 1.7};
        double lo = -1, hi = 1, steepest = 0;
        for (int i = 0; i < 80; i++) {
            const double s[2] = {hi - golden * (hi - lo), lo + golden * (hi - lo)};
            double slope[2];
            for (int j = 0; j < 2; j++) {
                slope[j] = pow(1 + A * s[j], (gamma - 3) / 2) * sqrt(1 - s[j] * s[j]);
                steepest = fmax(steepest, slope[j]);
            }
            *(slope[0] < slope[1] ? &lo : &hi) = slope[0] < slope[1] ? s[0] : s[1];
        }
        near_relative(simple_wave_breaking_time(&w),
                      1 / ((gamma + 1) / 2 * sound(&w) * 2 * M_PI / 1.7 * A * steepest), 1e-12);
    }
}

TEST(faults)
{
    static const double nan = (double)NAN, inf = HUGE_VAL;
    static const char gamma[] = "gamma must be finite and above 1",
                      rho[] = "rho0 must be finite and above 0",
                      P[] = "P0 must be finite and above 0",
                      length[] = "length must be finite and above 0",
                      amplitude[] = "amplitude must lie between -1 and 1",
                      v[] = "v0 must be finite";
    static const struct {
        struct simple_wave wave;
        const char *fault; /* NULL: none */
    } rows[] = {
        {{1, 1, 0, 1, 0.1, 1}, gamma},       {{1.0000001, 1, 0, 1, 0.1, 1}, NULL},
        {{nan, 1, 0, 1, 0.1, 1}, gamma},     {{inf, 1, 0, 1, 0.1, 1}, gamma},
        {{1.4, 0, 0, 1, 0.1, 1}, rho},       {{1.4, 1e-9, 0, 1e-9, 0.1, 1e-9}, NULL},
        {{1.4, nan, 0, 1, 0.1, 1}, rho},     {{1.4, inf, 0, 1, 0.1, 1}, rho},
        {{1.4, 1, 0, 0, 0.1, 1}, P},         {{1.4, 1, 0, -1, 0.1, 1}, P},
        {{1.4, 1, 0, inf, 0.1, 1}, P},       {{1.4, 1, 0, 1, 0.1, 0}, length},
        {{1.4, 1, 0, 1, 0.1, inf}, length},  {{1.4, 1, 0, 1, 1, 1}, amplitude},
        {{1.4, 1, 0, 1, -1, 1}, amplitude},  {{1.4, 1, 0, 1, 0.9999999, 1}, NULL},
        {{1.4, 1, 0, 1, nan, 1}, amplitude}, {{1.4, 1, nan, 1, 0.1, 1}, v},
        {{1.4, 1, inf, 1, 0.1, 1}, v},
    };
    assert_null(simple_wave_fault(&wave));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *fault = simple_wave_fault(&rows[i].wave);
        if (rows[i].fault)
            assert_string_equal(fault, rows[i].fault);
        else
            assert_null(fault);
    }
}

/* Values beyond the range of double, and times before the start or infinite, give NaN. */
TEST(beyond_double)
{
    const struct simple_wave fast = {1.4, 1, 1e308, 1, 1e-3, 1};
    assert_true(isnan(simple_wave_sample(&fast, 0.3, 5).rho)); /* moved infinitely far */
    assert_true(isnan(simple_wave_sample(&wave, HUGE_VAL, 0).rho));
    assert_true(isnan(simple_wave_sample(&wave, 0.3, -DBL_TRUE_MIN).rho));
    assert_true(isnan(simple_wave_sample(&wave, 0.3, (double)NAN).rho));
    assert_true(isfinite(simple_wave_sample(&wave, 0.3, 0).rho));
}

/* 1 to the left, -1 to the right, NaN between. */
static double torn(double x, void *parameters)
{
    (void)parameters;
    return fabs(x) < 0.9 ? (double)NAN : x < 0 ? 1 : -1;
}

/* Every search for a starting point ends: GSL's stops at NaN, and any valid wave has values between
 * its extremes at any time until it breaks, or NaN beyond the range of double. */
TEST(every_search_ends)
{
    gsl_function f = {torn, NULL};
    gsl_error_handler_t *const handler = gsl_set_error_handler_off();
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    assert_int_equal(gsl_root_fsolver_set(solver, &f, -1, 1), GSL_SUCCESS);
    assert_int_equal(gsl_root_fsolver_iterate(solver), GSL_EBADFUNC);
    gsl_root_fsolver_free(solver);
    gsl_set_error_handler(handler);
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    int known = 0;
    for (int i = 0; i < 3000; i++) {
        double any[6], u[4];
        for (int k = 0; k < 4; k++) u[k] = gsl_rng_uniform(random);
        for (int k = 0; k < 6; k++) any[k] = pow(10, 600 * gsl_rng_uniform(random) - 300);
        const struct simple_wave w = {.gamma = 1 + pow(10, i % 2 ? 20 * u[0] - 15 : 2 * u[0] - 1),
                                      .rho0 = i % 3 ? 2 : any[0],
                                      .v0 = i % 5 ? 0 : any[1],
                                      .P0 = i % 3 ? 3 : any[2],
                                      .amplitude = i % 7 ? 2 * u[1] - 1 : 1 - pow(10, -15 * u[1]),
                                      .length = i % 4 ? 1.7 : any[3]};
        assert_null(simple_wave_fault(&w));
        const double late = i % 2 ? u[2] : 1 - pow(10, -16 * u[2]);
        const double x = i % 11 ? (4 * u[3] - 2) * w.length : any[4];
        const struct simple_wave_state s =
            simple_wave_sample(&w, x, late * simple_wave_breaking_time(&w));
        assert_true(isnan(s.rho) || fabs(s.rho / w.rho0 - 1) <= fabs(w.amplitude) + 1e-14);
        known += !isnan(s.rho);
    }
    gsl_rng_free(random);
    assert_true(known > 1500);
}
