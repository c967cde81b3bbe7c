/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares what is measured of tubes (shocks, noise, regions, gas still at rest), and the time
 * until waves reach their window, with independent computations, on random tubes and tubes made by
 * hand. */
#include "test.h"

#include <gsl/gsl_rng.h>

#include "gases.h"

/* ---- tubes drawn at random ---- */

static double between(gsl_rng *random, double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(random);
}

static double sound(double gamma, const struct riemann_state *gas)
{
    return sqrt(gamma * gas->P / gas->rho);
}

/* Tubes of all kinds: equal gases, gases faster than sound, vacuum that opens, also between a dense
 * and a thin gas, windows of any width. */
static struct prepared drawn(gsl_rng *random, struct settings *settings)
{
    enum { ANY, FAST, APART, EQUAL, THIN, KINDS };
    char keys[256];
    const int kind = (int)gsl_rng_uniform_int(random, KINDS);
    const double gamma = between(random, 1.1, kind == THIN ? 1.4 : 3), a = between(random, 0, 0.5),
                 b = between(random, 0.5, 1);
    struct riemann_state l = {pow(10, between(random, -1, 1)), between(random, -1, 1),
                              pow(10, between(random, -2, 1))},
                         r = {l.rho * pow(10, between(random, -1, 1)), 0,
                              l.P * pow(10, between(random, -2, 2))};
    if (kind == FAST) l.v *= 20;
    r.v = l.v + between(random, -3, 3);
    if (kind == APART) r.v = l.v + between(random, 5, 20);
    if (kind == EQUAL) r = l;
    if (kind == THIN) { /* and of the same temperature */
        const double part = pow(10, between(random, -4, 4));
        r.rho = l.rho * part;
        r.P = l.P * part;
        r.v = l.v + between(random, 1, 1.5) * 4 * sound(gamma, &l) / (gamma - 1);
    }
    snprintf(keys, sizeof keys,
             "lo=-1.5|hi=0.5|gamma=%.17g|window=%.17g %.17g|left=%.17g %.17g %.17g|right=%.17g "
             "%.17g %.17g",
             gamma, -1.5 + 2 * a, -1.5 + 2 * b, l.rho, l.v, l.P, r.rho, r.v, r.P);
    return prepared_of(settings, 1, keys);
}

/* ---- time until waves reach the window ---- */

/* The earliest time at which waves from the left end of the tube l | r, where its mirror image
 * begins, `length` from its middle, may have travelled a distance of `way`; infinite: never. */
static double arrival(double gamma, const struct riemann_state *l, const struct riemann_state *r,
                      double length, double way)
{
    struct riemann_solution main, mirror;
    assert_null(riemann_solve(gamma, l, r, &main));
    assert_null(riemann_solve(gamma, r, l, &mirror));
    const double c = sound(gamma, l);
    if (isnan(main.left_head)) return l->v + c > 0 ? way / (l->v + c) : HUGE_VAL; /* no waves */
    const double speed = mirror.right_head, other = -main.left_head;
    const double meet = speed + other > 0 ? length / (speed + other) : HUGE_VAL;
    if (way <= speed * meet) return speed > 0 ? way / speed : HUGE_VAL;
    /* assume that the wave has the same Mach number in all other gas as in l */
    const double mach = fmax(1, (speed - l->v) / c);
    const struct riemann_state stars[2] = {{main.rho_star_left, main.v_star, main.p_star},
                                           {main.rho_star_right, main.v_star, main.p_star}};
    double fast = fmax(0, speed);
    fast = fmax(fast, l->v + mach * c);
    fast = fmax(fast, r->v + mach * sound(gamma, r));
    for (int k = 0; k < 2 && !main.vacuum; k++)
        fast = fmax(fast, stars[k].v + mach * sound(gamma, &stars[k]));
    return meet + (way - speed * meet) / fast;
}

/* The time until waves from the ends reach the window of a tube. */
static double free_until(const struct prepared *p, const struct settings *settings)
{
    const struct gases gases = gases_of(p->gamma, settings);
    struct riemann_state l = gases.right, r = gases.left; /* mirrored */
    l.v = -l.v;
    r.v = -r.v;
    const double length = 0.5 * domain_length(&p->domain, 0);
    return fmin(
        arrival(p->gamma, &gases.left, &gases.right, length, p->window.lo[0] - p->domain.lo[0]),
        arrival(p->gamma, &l, &r, length, p->domain.hi[0] - p->window.hi[0]));
}

TEST(windows_are_free_until_waves_come)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    int for_ever = 0;
    for (int i = 0; i < 3000; i++) {
        struct settings s;
        const struct prepared p = drawn(random, &s);
        const double t = free_until(&p, &s);
        for_ever += isinf(t);
        if (isinf(t)
                ? p.problem->holds(&p, 1e9)
                : p.problem->holds(&p, t * (1 - 1e-9)) && !p.problem->holds(&p, t * (1 + 1e-9)))
            continue;
        fail_msg("tube %d: not free until %.17g", i, t);
    }
    assert_true(for_ever < 100);
    gsl_rng_free(random);
    struct settings s;
    const struct prepared all = prepared_of(&s, 1, "window=-1 1|left=1 0 1");
    assert_true(all.problem->holds(&all, 0) && !all.problem->holds(&all, 1e-9));
    /* the gas leaves the left end a little faster than sound: no wave enters there, and from the
     * right end waves come at twice the speed of sound */
    char keys[128];
    const double c = sqrt(1.4);
    snprintf(keys, sizeof keys, "left=1 %.17g 1|right=1 %.17g 1|window=-1 -0.75", -c * (1 + 1e-9),
             -c * (1 + 1e-9));
    const struct prepared away = prepared_of(&s, 1, keys);
    assert_true(away.problem->holds(&away, 0.874 / c) && !away.problem->holds(&away, 0.876 / c));
}

/* ---- the shock ---- */

TEST(shocks_are_found_from_the_right)
{
    struct settings s;
    const struct prepared p =
        prepared_of(&s, 1, "lo=-1|hi=3|window=-0.5 2|left=1 0 1|right=0.125 0 0.1");
    const struct functional *place = prepared_functional(&p, "shock_position");
    const struct gases gases = gases_of(1.4, &s);
    const double level = 0.5 * (gases.main.p_star + 0.1);
    near_relative(place->exact(&p, 0.25), 1 + 0.25 * gases.main.right_head, 1e-15);
    assert_true(place->present(&p));
    const struct {
        size_t n;
        double x[5], P[5]; /* P in units of the level */
        double want;       /* NaN: none */
    } rows[] = {
        {5, {0, 0.25, 0.75, 1, 1.5}, {2, 2, 1.5, 0.5, 0.25}, 0.875},
        {5, {0, 0.25, 0.75, 1, 1.5}, {2, 0.5, 1.5, 0.75, 0.25}, 0.75 + 0.25 * 2 / 3},
        {5, {0, 0.25, 0.75, 1, 1.5}, {0, 1, 0.5, 0.25, 0}, 0.25},    /* exactly at the level */
        {5, {0, 0.25, 0.75, 1, 1.5}, {2, 1.5, 1, 1, 0.25}, 1},       /* not before it */
        {5, {0, 0.25, 0.75, 2, 2.5}, {2, 2, 1.5, 0.5, 0.25}, 1.375}, /* up to the window's end */
        {5, {0, 0.25, 0.75, 2.000001, 2.5}, {3, 0.5, 1.5, 0.5, 2}, 0.2},
        {2, {0, 0.5, 1, 1.5, 2}, {1.5, 0.5, 4, 0, 0}, 0.25},
        {5, {0, 0.25, 0.75, 1, 1.5}, {2, 2, 2, 2, 2}, (double)NAN},
        {5, {0, 0.25, 0.75, 1, 1.5}, {2, 2, 2, 2, 1}, (double)NAN},
        {5, {0, 0.25, 0.75, 1, 1.5}, {0.5, 0.5, 0.5, 0.5, 0.5}, (double)NAN},
        {1, {0, 0.25, 0.75, 1, 1.5}, {2, 0, 0, 0, 0}, (double)NAN},
        {0, {0, 0.25, 0.75, 1, 1.5}, {2, 0, 0, 0, 0}, (double)NAN},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        double x[6] = {-9}, P[6] = {9}; /* the element before the first must not count */
        for (int i = 0; i < 5; i++) x[i + 1] = rows[k].x[i], P[i + 1] = level * rows[k].P[i];
        const struct snapshot of = {.n = rows[k].n, .x = {x + 1}, .P = P + 1};
        const double found = place->measure(&p, &of);
        if (isnan(rows[k].want))
            assert_true(isnan(found));
        else
            near_relative(found, rows[k].want, 1e-13);
    }
    const struct prepared fan = prepared_of(&s, 1, "left=0.125 0 0.1|right=1 0 1");
    assert_false(place->present(&fan));
    const struct prepared wide = prepared_of(&s, 2, "left=1 0 1|right=0.125 0 0.1");
    assert_false(place->present(&wide));
    const struct prepared wide_fan = prepared_of(&s, 2, "left=0.125 0 0.1|right=1 0 1");
    assert_false(place->present(&wide_fan));
}

/* ---- transverse motion ---- */

TEST(noise_is_that_of_disturbed_gas)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int shifted = 0; shifted < 2; shifted++) {
            struct settings s;
            const struct prepared p =
                prepared_of(&s, dim,
                            shifted ? "lo=-0.75|hi=1.25|left=1 0 1|right=0.125 0 0.1"
                                    : "lo=-1|hi=1|left=1 0 1|right=0.125 0 0.1");
            const struct functional *noise = prepared_functional(&p, "transverse_noise");
            const struct riemann_solution tube = gases_of(1.4, &s).main;
            /* at t = 1/2: positions on the head and on the shock are not between them (exact for x
             * near 0); one more after the last */
            const double x0 = 0.25 * shifted, head = 0.5 * tube.left_head,
                         shock = 0.5 * tube.right_head, off = 1e-9, out = shifted ? 1e-9 : 0;
            const double x[] = {x0 + head * (1 - off),
                                x0 + head * (1 + out),
                                x0 + shock * (1 + out),
                                x0 + shock * (1 - off),
                                -0.74,
                                1.2,
                                0.1},
                         v[3][7] = {{5, 6, 7, 8, 9, 4, 3},
                                    {3, 5, 7, 2, 9, 4, 9},
                                    {4, 1, 2, 1, 8, 4, 9}},
                         volume[] = {2, 1, 3, 5, 7, 11, 13};
            struct snapshot of = {
                .n = 6, .x = {x}, .v = {v[0], v[1], v[2]}, .volume = volume, .time = 0.5};
            const double across = 2 * (9 + (dim == 3 ? 16 : 0)) + 5 * (4 + (dim == 3 ? 1 : 0));
            near_relative(noise->measure(&p, &of), sqrt(across / 7), 1e-14);
            assert_true(noise->exact(&p, 0.5) == 0 && noise->present(&p));
            of.n = 0;
            assert_true(noise->measure(&p, &of) == 0); /* no particles */
        }
    struct settings s;
    const struct prepared line = prepared_of(&s, 1, "left=1 0 1");
    assert_false(prepared_functional(&line, "transverse_noise")->present(&line));
}

/* ---- regions ---- */

static bool is_near(double x, double place, double reach)
{
    return x >= place - reach && x <= place + reach; /* false for NaN */
}

static const char *region_of(const struct riemann_solution *tube, double x, double reach, double t)
{
    if ((tube->left_wave == RIEMANN_SHOCK && is_near(x, tube->left_head * t, reach)) ||
        (tube->right_wave == RIEMANN_SHOCK && is_near(x, tube->right_head * t, reach)))
        return "shock";
    if (is_near(x, tube->contact * t, reach)) return "contact";
    if (tube->left_wave == RIEMANN_RAREFACTION && x >= tube->left_head * t - reach &&
        x <= tube->left_tail * t + reach)
        return "fan";
    if (tube->right_wave == RIEMANN_RAREFACTION && x >= tube->right_tail * t - reach &&
        x <= tube->right_head * t + reach)
        return "fan";
    return x < tube->left_head * t || x > tube->right_head * t ? "undisturbed" : "plateau";
}

TEST(regions_lie_between_waves)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    int seen[5] = {0};
    for (int i = 0; i < 1000; i++) {
        struct settings s;
        const struct prepared p = drawn(random, &s);
        const struct regions *regions = p.problem->regions;
        const struct riemann_solution tube = gases_of(p.gamma, &s).main;
        const double t = 0.5, waves[] = {tube.left_head, tube.left_tail, tube.contact,
                                         tube.right_tail, tube.right_head};
        for (int k = 0; k < 40; k++) {
            const double reach = k % 4 ? 0.1 * gsl_rng_uniform(random) : 0;
            /* also near waves: on either side, off by a millionth of the reach */
            const double wave = waves[k % 5] * t, side = k % 2 ? -1 : 1, off = k % 3 ? 1e-6 : -1e-6;
            const double x = k < 20 || isnan(wave) ? between(random, -1, 1)
                                                   : wave + side * (reach + off * (reach + 1e-3));
            const size_t at = regions->at(&p, (double[3]){x - 0.5, 9, 9}, reach, t);
            assert_true(at < 5);
            assert_string_equal(regions->names[at], region_of(&tube, x, reach, t));
            seen[at]++;
        }
    }
    gsl_rng_free(random);
    for (int k = 0; k < 5; k++) assert_true(seen[k] > 100);
    /* exactly on waves, in boxes around 0: they belong to the region that they bound */
    for (int turned = 0; turned < 2; turned++) {
        struct settings s;
        const struct prepared p =
            prepared_of(&s, 1, turned ? "left=0.125 0 0.1|right=1 0 1" : "left=1 0 1");
        const struct regions *regions = p.problem->regions;
        const struct riemann_solution tube = gases_of(1.4, &s).main;
        const double head = turned ? tube.right_head : tube.left_head,
                     tail = turned ? tube.right_tail : tube.left_tail,
                     shock = turned ? tube.left_head : tube.right_head;
        const struct {
            double x;
            const char *name;
        } rows[] = {{head, "fan"},
                    {head * (1 + 1e-15), "undisturbed"},
                    {tail, "fan"},
                    {tail * (1 - 1e-14), "plateau"},
                    {tube.contact, "contact"},
                    {tube.contact * (1 + 1e-14), "plateau"},
                    {shock, "shock"},
                    {shock * (1 - 1e-14), "plateau"},
                    {shock * (1 + 1e-14), "undisturbed"}};
        for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
            assert_string_equal(regions->names[regions->at(&p, (double[3]){rows[k].x}, 0, 1)],
                                rows[k].name);
    }
}

/* ---- undisturbed gas ---- */

/* A particle exactly at the limit is too near, and one a little further away is not. */
TEST(still_gas_begins_at_its_limits)
{
    struct settings s;
    const struct prepared p = prepared_of(&s, 1, "left=1 0 1|right=0.125 0 0.1");
    const struct gases gases = gases_of(1.4, &s);
    const double way = gases.main.right_head * 0.125, back = -gases.mirror.left_head * 0.125;
    const struct {
        double x, h, widest, time; /* the limit, and the side where gas is undisturbed */
        int side;
    } rows[] = {
        {12. / 64, 1. / 64, 1. / 64, 0, 1},       {1 - 12. / 64, 1. / 64, 1. / 64, 0, -1},
        {-12. / 64, 1. / 64, 1. / 64, 0, -1},     {-1 + 12. / 64, 1. / 64, 1. / 64, 0, 1},
        {2. / 8, 1. / 1024, 1. / 8, 0, 1},        {1 - 2. / 8, 1. / 1024, 1. / 8, 0, -1},
        {12 * 0x1p-27, 0x1p-27, 0x1p-27, 0, 1},   {1.25 * way, 1e-4, 1e-4, 0.125, 1},
        {1 - 1.25 * back, 1e-4, 1e-4, 0.125, -1},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (int off = -1; off <= 1; off++) {
            /* the second particle is near the middle, and never undisturbed */
            const double x[2] = {rows[k].x + 1e-9 * off, 1e-10}, v[2] = {0.5, 9},
                         h[2] = {rows[k].h, rows[k].widest};
            const struct snapshot of = {.n = 2, .x = {x}, .v = {v}, .h = h, .time = rows[k].time};
            const double have = p.problem->regions->still(&p, &of);
            if (off == 0 && rows[k].time > 0) continue; /* the limit is not an exact number */
            assert_int_equal(!isnan(have), off == rows[k].side);
        }
    /* gas at the middle belongs to the left one: here all waves have passed it */
    const struct prepared fast = prepared_of(&s, 1, "left=1 5 1|right=4 5.5 1");
    const double x[1] = {0}, v[1] = {6}, h[1] = {1e-4};
    const struct snapshot of = {.n = 1, .x = {x}, .v = {v}, .h = h, .time = 0.1};
    near_relative(p.problem->regions->still(&fast, &of), 1 / sqrt(1.4), 1e-14);
}
