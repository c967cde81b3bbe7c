/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the exact Riemann solver on arbitrary input, at single points and at its limits. (The
 * checks `riemann` test a table of star states, and its laws on random problems.) */
#include "test.h"

#include <float.h>

#include "riemann.h"
#include "riemann_property.h"

/* Any double: special values, random bits, 600 decades. */
static double anything(gsl_rng *random)
{
    static const double special[] = {0,        -0.0,      1,        DBL_MIN,   DBL_MAX,
                                     -DBL_MAX, 0x1p-1074, HUGE_VAL, -HUGE_VAL, (double)NAN};
    const uint64_t bits = (uint64_t)gsl_rng_get(random) << 32 | gsl_rng_get(random);
    double value;
    switch (gsl_rng_uniform_int(random, 4)) {
    case 0:
        return special[gsl_rng_uniform_int(random, 10)];
    case 1:
        memcpy(&value, &bits, sizeof value);
        return value;
    case 2:
        return pow(10, 600 * gsl_rng_uniform(random) - 300);
    default:
        return 4 * gsl_rng_uniform(random) - 2;
    }
}

static bool in_order(double a, double b, double c)
{
    return a <= b && b <= c;
}

/* Any input is refused or has a solution with valid values, whose samples are valid. */
TEST(any_input)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    /* Where long double is no wider than double (on some machines, and under valgrind), 600 decades
     * overflow inside. */
    const volatile long double step = LDBL_EPSILON;
    const bool wide = LDBL_MANT_DIG > DBL_MANT_DIG && 1 + step > 1;
    int solved_count = 0;
    for (int i = 0; i < 100000; i++) {
        const double gamma =
            i % 3 ? 1 + pow(10, 20 * gsl_rng_uniform(random) - 16) : anything(random);
        struct riemann_state l = {fabs(anything(random)), anything(random), fabs(anything(random))};
        struct riemann_state r = {fabs(anything(random)), anything(random), fabs(anything(random))};
        if (i % 4 == 0) r.v = l.v;
        if (i % 5 == 0) r.P = l.P;
        struct riemann_solution s;
        if (riemann_solve(gamma, &l, &r, &s)) continue;
        solved_count++;
        assert_true(s.p_star >= 0 && s.rho_star_left >= 0 && s.rho_star_right >= 0);
        assert_true(s.vacuum == (isnan(s.v_star) != 0) && s.vacuum == (isnan(s.contact) != 0));
        if (wide && !s.vacuum && s.left_wave)
            assert_true(in_order(s.left_head, s.left_tail, s.contact));
        if (wide && !s.vacuum && s.right_wave)
            assert_true(in_order(s.contact, s.right_tail, s.right_head));
        if (wide && s.left_wave == RIEMANN_SHOCK)
            assert_true(s.p_star >= l.P && s.rho_star_left >= l.rho);
        if (wide && s.right_wave == RIEMANN_RAREFACTION) assert_true(s.p_star <= r.P);
        const double places[] = {anything(random), s.left_head, s.left_tail, s.right_tail,
                                 s.right_head};
        for (int k = 0; k < 5; k++) {
            if (!isfinite(places[k])) continue;
            const struct riemann_state at = riemann_sample(&s, places[k], 0, 1);
            assert_true(at.rho >= 0 && at.P >= 0 && (at.rho == 0 || !isnan(at.v)));
        }
    }
    gsl_rng_free(random);
    assert_true(solved_count > 20000);
}

/* ---- single points ---- */

static struct riemann_solution solved(double gamma, struct riemann_state left,
                                      struct riemann_state right)
{
    struct riemann_solution s;
    assert_null(riemann_solve(gamma, &left, &right, &s));
    return s;
}

TEST(equal_states)
{
    const struct riemann_state gas = {0.7, -1.3, 2.1};
    const struct riemann_solution s = solved(1.4, gas, gas);
    assert_int_equal(s.left_wave, RIEMANN_NONE);
    assert_int_equal(s.right_wave, RIEMANN_NONE);
    assert_true(s.p_star == 2.1 && s.v_star == -1.3 && s.rho_star_left == 0.7);
    assert_true(isnan(s.left_head) && isnan(s.right_tail) && s.contact == -1.3);
    for (int i = -5; i <= 5; i++) {
        const struct riemann_state at = riemann_sample(&s, i, 0.1, 0.3);
        assert_true(at.rho == 0.7 && at.v == -1.3 && at.P == 2.1);
    }
}

/* The same problem with a unit of velocity of 2^e: p* scales with 2^(2 e), also below the least
 * normal number, where the solution is marked as underflown. */
TEST(states_near_underflow)
{
    static const int exponents[] = {-100, -500, -509, -511, 300};
    const struct riemann_state left = {1, -1, 1}, right = {0.7, 1.3, 1.1};
    struct riemann_solution base, s;
    assert_null(riemann_solve(1.4, &left, &right, &base));
    assert_false(base.underflow);
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        const int e = exponents[i];
        const struct riemann_state l = {left.rho, ldexp(left.v, e), ldexp(left.P, 2 * e)};
        const struct riemann_state r = {right.rho, ldexp(right.v, e), ldexp(right.P, 2 * e)};
        const double expected = ldexp(base.p_star, 2 * e);
        assert_null(riemann_solve(1.4, &l, &r, &s));
        assert_true(s.underflow == (expected < DBL_MIN));
        assert_true(fabs(s.p_star - expected) <= 1e-14 * expected + 2 * DBL_TRUE_MIN);
        near_relative(s.rho_star_left, base.rho_star_left, 1e-14);
        near_relative(s.v_star, ldexp(base.v_star, e), 1e-14);
    }
}

/* A density that underflows on either side is marked, too: thin gas that moves away from a wall. */
TEST(underflow_of_one_side)
{
    for (int side = -1; side <= 1; side += 2) {
        const struct riemann_state thin = {4e-308, side * 1.18e154, 1}, wall = {1, 0, 1e-9};
        struct riemann_solution s;
        assert_null(riemann_solve(1.4, side < 0 ? &thin : &wall, side < 0 ? &wall : &thin, &s));
        near_relative(s.p_star, pow(1 - 0.2 * 1.18e154 / sqrt(1.4 / 4e-308), 7), 1e-9);
        const double rho = side < 0 ? s.rho_star_left : s.rho_star_right;
        assert_true(rho > 0 && rho < DBL_MIN);
        assert_true(s.underflow);
    }
}

TEST(cold_gas)
{
    /* Noh's problem: P = (gamma+1)/2 rho v^2, rho* = (gamma+1)/(gamma-1), shocks at (gamma-1)/2 */
    const struct riemann_state in = {1, 1, 0}, out = {1, -1, 0};
    const struct riemann_solution s = solved(5. / 3, in, out);
    near_relative(s.p_star, 4. / 3, 1e-15);
    near_relative(s.rho_star_left, 4, 1e-14);
    near_relative(s.right_head, 1. / 3, 1e-14);
    assert_true(s.v_star == 0);
    /* cold gases that move apart leave vacuum at once; cold gas at rest stays */
    assert_true(solved(1.4, out, in).vacuum);
    const struct riemann_solution still = solved(1.4, in, in);
    assert_true(!still.vacuum && still.p_star == 0 && still.v_star == 1);
    /* hot gas expands into cold gas: an infinitely strong shock */
    const struct riemann_solution mixed =
        solved(1.4, (struct riemann_state){1, 0, 1}, (struct riemann_state){1, 0, 0});
    assert_int_equal(mixed.right_wave, RIEMANN_SHOCK);
    near_relative(mixed.rho_star_right, 6, 1e-14);
    near_below(riemann_defects_of(&mixed).energy, 1e-14);
}

/* Hot gas, at rest or moving, beside cold gas: the rarefaction and the strong shock have one
 * pressure and one velocity, found by bisection. */
TEST(hot_gas_beside_cold_gas)
{
    for (int k = 0; k < 8; k++) {
        const double gamma = 1.2 + 0.2 * k, rho = k % 2 ? 0.3 : 5, v = 0.5 * (k % 3) - 0.5;
        const struct riemann_state hot = {1.5, v, 2}, cold = {rho, 0, 0};
        const struct riemann_solution s = solved(gamma, hot, cold),
                                      t = solved(gamma, cold, (struct riemann_state){1.5, -v, 2});
        const double z = (gamma - 1) / (2 * gamma), c = sqrt(gamma * 2 / 1.5);
        double lo = 0, hi = 1e3; /* higher p: slower on the left, faster on the right */
        for (int i = 0; i < 200; i++) {
            const double p = 0.5 * (lo + hi), behind = sqrt(2 * p / ((gamma + 1) * rho));
            const double left =
                p < 2 ? v - 2 * c / (gamma - 1) * (pow(p / 2, z) - 1)
                      : v - (p - 2) * sqrt(2 / (1.5 * ((gamma + 1) * p + (gamma - 1) * 2)));
            *(left > behind ? &lo : &hi) = p;
        }
        near_relative(s.p_star, lo, 1e-13);
        near_relative(s.v_star, sqrt(2 * lo / ((gamma + 1) * rho)), 1e-13);
        near_relative(s.rho_star_right, rho * (gamma + 1) / (gamma - 1), 1e-13);
        near_relative(s.right_head, s.v_star * (gamma + 1) / 2, 1e-13);
        assert_true(t.p_star == s.p_star && t.v_star == -s.v_star && t.left_head == -s.right_head);
    }
}

/* Hot gas that almost separates from very heavy cold gas at rest: both move with v = sqrt(2
 * p/((gamma + 1) rho)), the speed of the heavy gas; along the fan of the light gas it is less
 * precise. */
TEST(heavy_gas_beside_light_gas)
{
    const double gamma = 1.4, c = sqrt(1.4), apart = 2 * c / (gamma - 1);
    for (int k = 0; k <= 18; k++)
        for (int j = 0; j < 6; j++) {
            const double rho = pow(10, k), v = -apart * (1 - 1e-3 * pow(6, j) / 8);
            const struct riemann_state hot = {1, v, 1}, back = {1, -v, 1}, cold = {rho, 0, 0};
            const struct riemann_solution s = solved(gamma, hot, cold),
                                          t = solved(gamma, cold, back);
            const double pushed = sqrt(2 * s.p_star / ((gamma + 1) * rho));
            near_relative(s.v_star, pushed, 1e-14);
            near_relative(s.right_head, 1.2 * pushed, 1e-14);
            assert_true(t.v_star == -s.v_star && t.left_head == -s.right_head);
            /* along the fan */
            const double jump = apart * (1 - pow(s.p_star, 1. / 7));
            near_absolute(v + jump - s.v_star, 0, 1e-13);
        }
}

/* Cold gases that collide: the bits are the same in units of velocity of 2^e. */
TEST(cold_in_other_units)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < 200; i++) {
        const int e = i % 2 ? 300 : -250;
        struct riemann_state l = {0.1 + gsl_rng_uniform(random), gsl_rng_uniform(random), 0},
                             r = {5 * gsl_rng_uniform(random), -gsl_rng_uniform(random), 0};
        const struct riemann_solution s = solved(1.4, l, r);
        l.v = ldexp(l.v, e), r.v = ldexp(r.v, e);
        const struct riemann_solution other = solved(1.4, l, r);
        assert_true(other.p_star == ldexp(s.p_star, 2 * e));
        assert_true(other.v_star == ldexp(s.v_star, e));
        assert_true(other.left_head == ldexp(s.left_head, e));
        assert_true(other.rho_star_left == s.rho_star_left);
    }
    gsl_rng_free(random);
}

TEST(sample_regions)
{
    const struct riemann_state left = {1, 0, 1}, right = {0.125, 0, 0.1};
    const struct riemann_solution s = solved(1.4, left, right);
    struct riemann_state at = riemann_sample(&s, 0.25, 0.25, 0);
    assert_true(at.rho == 1);
    at = riemann_sample(&s, nextafter(0.25, 1), 0.25, 0);
    assert_true(at.rho == 0.125 && at.P == 0.1);
    /* exactly on a wave */
    at = riemann_sample(&s, s.contact, 0, 1);
    assert_true(at.rho == s.rho_star_left && at.v == s.v_star && at.P == s.p_star);
    assert_true(riemann_sample(&s, s.left_head, 0, 1).rho == 1);
    assert_true(riemann_sample(&s, s.left_tail, 0, 1).rho == s.rho_star_left);
    assert_true(riemann_sample(&s, s.right_head, 0, 1).rho == 0.125);
    assert_true(riemann_sample(&s, nextafter(s.right_head, 0), 0, 1).rho == s.rho_star_right);
    at = riemann_sample(&s, 0.25 + 0.5 * 0.92, 0.25, 0.5);
    near_relative(at.rho, 0.42631942817849519, 1e-14);
    at = riemann_sample(&s, 0.25 + 0.5 * 0.93, 0.25, 0.5);
    near_relative(at.rho, 0.26557371170530706, 1e-14);
    near_relative(at.v, 0.92745262004894995, 1e-14);
    at = riemann_sample(&s, 0.25 + 0.5 * 1.7521, 0.25, 0.5);
    near_relative(at.P, 0.30313017805064682, 1e-14);
    at = riemann_sample(&s, 0.25 + 0.5 * 1.7522, 0.25, 0.5);
    assert_true(at.P == 0.1);
    /* at the sonic point x = x0 of the fan in Toro's modified Sod problem, c = v */
    const struct riemann_solution toro =
        solved(1.4, (struct riemann_state){1, 0.75, 1}, (struct riemann_state){0.125, 0, 0.1});
    at = riemann_sample(&toro, 3, 3, 0.2);
    near_relative(sqrt(1.4 * at.P / at.rho), at.v, 1e-14);
}

TEST(vacuum_samples)
{
    const struct riemann_state gas = {1, 0, 1}, none = {0, 7, 0};
    struct riemann_solution s = solved(1.4, gas, none);
    struct riemann_state at = riemann_sample(&s, 6, 0, 1);
    assert_true(at.rho == 0 && at.P == 0 && isnan(at.v));
    at = riemann_sample(&s, 6, 0, 0);
    assert_true(at.rho == 0 && at.v == 7);
    at = riemann_sample(&s, s.left_tail - 1e-3, 0, 1);
    assert_true(at.rho > 0 && at.rho < 1e-15 && at.P > 0);
    /* at the front of the gas, 3 - 2 3/(3 - 1), the density is 0 */
    for (int side = -1; side <= 1; side += 2) {
        const struct riemann_state hot = {1, 3 * side, 3}, away = {0, 0, 0};
        s = side < 0 ? solved(3, hot, away) : solved(3, away, hot);
        at = riemann_sample(&s, 0, 0, 1);
        assert_true(at.rho == 0 && isnan(at.v) && at.P == 0);
        near_relative(riemann_sample(&s, 1.5 * side, 0, 1).rho, 0.25, 1e-14);
        assert_true(isnan(riemann_sample(&s, -1e-9 * side, 0, 1).v));
    }
    s = solved(1.4, none, none);
    at = riemann_sample(&s, 0, 0, 1);
    assert_true(s.vacuum && s.left_wave == RIEMANN_NONE && at.rho == 0);
    /* with vacuum in the middle: gas, fan, vacuum, fan, gas */
    s = solved(1.4, (struct riemann_state){1, -5, 0.4}, (struct riemann_state){1, 5, 0.4});
    assert_true(riemann_sample(&s, -6, 0, 1).rho == 1);
    assert_true(riemann_sample(&s, -2, 0, 1).rho > 0);
    assert_true(riemann_sample(&s, 1.25, 0, 1).rho == 0);
    assert_true(riemann_sample(&s, 1.27, 0, 1).rho > 0);
    assert_true(riemann_sample(&s, 6, 0, 1).v == 5);
}

TEST(bad_input)
{
    static const double nan = (double)NAN, inf = HUGE_VAL;
    static const char finite[] = "density, velocity and pressure must be finite",
                      negative[] = "density and pressure must not be negative",
                      empty[] = "density 0 with a pressure above 0 (vacuum has both 0)",
                      beyond[] = "the solution leaves the range of double precision";
    static const struct {
        struct riemann_state gas;
        const char *fault;
    } rows[] = {{{-1, 0, 1}, negative},
                {{1, 0, -1}, negative},
                {{0, 0, 1}, empty},
                {{0, 0, 1e-300}, empty},
                {{nan, 0, 1}, finite},
                {{1, nan, 1}, finite},
                {{1, 0, inf}, finite},
                {{1, -inf, 1}, finite},
                {{1e308, 1e308, 1e308}, beyond} /* (on the right: the gases separate) */};
    const struct riemann_state good = {1, 0, 1};
    const double gammas[] = {1, 0.9, -2, nan, inf};
    struct riemann_solution s = {.gamma = 42};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_string_equal(riemann_solve(1.4, &rows[i].gas, &good, &s), rows[i].fault);
        if (rows[i].fault != beyond)
            assert_string_equal(riemann_solve(1.4, &good, &rows[i].gas, &s), rows[i].fault);
    }
    /* only the head of the fan is too fast: c = 2e307 */
    const struct riemann_state far = {3.5e-307, -1.7e308, 1e308}, none = {0, 0, 0},
                               back = {3.5e-307, 1.7e308, 1e308};
    assert_string_equal(riemann_solve(1.4, &far, &none, &s), beyond);
    assert_string_equal(riemann_solve(1.4, &none, &back, &s), beyond);
    /* the message is about the left state if both are wrong */
    assert_string_equal(riemann_solve(1.4, &rows[0].gas, &rows[4].gas, &s), negative);
    assert_string_equal(riemann_solve(1.4, &rows[4].gas, &rows[0].gas, &s), finite);
    for (size_t i = 0; i < sizeof gammas / sizeof *gammas; i++)
        assert_string_equal(riemann_solve(gammas[i], &good, &good, &s),
                            "gamma must be finite and above 1");
    assert_true(s.gamma == 42);
    assert_null(riemann_solve(1 + 1e-9, &good, &good, &s));
}

/* Two gases that collide gently: a shock of strength d = p* - P on both sides, by Hugoniot a root
 * of d^2 - (gamma + 1)/2 rho w^2 d - gamma P rho w^2. Then gases at the speed at which vacuum
 * forms. */
TEST(weak_shocks_and_onset_of_vacuum)
{
    for (int k = -14; k <= 0; k++)
        for (int digit = 1; digit < 10; digit += 2) {
            const double w = digit * pow(10, k), gamma = 1.4, b = 1.2 * w * w, c = 1.4 * w * w;
            const struct riemann_state l = {1, w, 1}, r = {1, -w, 1};
            const struct riemann_solution s = solved(gamma, l, r);
            const double d = (b + sqrt(b * b + 4 * c)) / 2;
            near_below(fabs(s.p_star - 1 - d), 3e-16 * (1 + d) + 1e-13 * d * d);
            near_below(fabs(s.v_star), 1e-18);
        }
    /* gases of equal state have the mean velocity */
    const struct riemann_state fast = {1, 0.75, 1}, slow = {1, 0.25, 1};
    assert_true(solved(1.4, fast, slow).v_star == 0.5);
    assert_true(solved(1.4, slow, fast).v_star == 0.5);
    /* gamma = 3, c = 3: vacuum forms at 2 (c + c)/(gamma - 1) = 6 */
    const struct riemann_solution just =
        solved(3, (struct riemann_state){1, -3, 3}, (struct riemann_state){1, 3, 3});
    assert_true(just.vacuum && just.left_tail == 0 && just.right_tail == 0);
    /* a difference of 6 - 2^-50, the next below 6: exact for any long double */
    const struct riemann_solution nearly =
        solved(3, (struct riemann_state){1, -3, 3}, (struct riemann_state){1, 3 - 0x1p-50, 3});
    assert_false(nearly.vacuum);
    /* gamma = 7: cold gas reaches a velocity of 1/2 with a pressure of 1, which is that of the left
     * gas: its wave has no strength and, as for gas at rest, counts as a rarefaction */
    const struct riemann_state pushes = {2, 0.5, 1}, waits = {1, 0, 0};
    const struct riemann_solution pushed = solved(7, pushes, waits);
    assert_true(pushed.p_star == 1 && pushed.v_star == 0.5 && pushed.rho_star_left == 2);
    assert_int_equal(pushed.left_wave, RIEMANN_RAREFACTION);
    assert_true(pushed.left_head == pushed.left_tail);
    near_relative(pushed.left_head, 0.5 - sqrt(3.5), 1e-15);
}
