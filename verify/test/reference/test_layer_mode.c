/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tests the fastest growing mode of a layer: its units, and layers without a growing mode. (The
 * check `exact layer_modes` tests its equations, ends and growth rate.) */
#include "test.h"

#include <complex.h>

#include "layer_collocation.h"
#include "layer_mode.h"

static const struct layer layers[] = {
    {1.4, 2 * M_PI, 0.07, 1.3, 0.2, 0.4, 1.7, 0, true, 0, false},
    {1.6, 2 * M_PI, 0.05, 1.3, -0.4, 0.5, 1.7, 0, true, 0, true},
    {1.4, 3, 0.07, 1.3, 0.2, 0.4, 1.7, 0, false, 0.6, false},
    {5. / 3, 7, 0.05, 1.5, 0.5, 0.3, 2.5, 0.4, false, 0.45, false},
    {1.4, 8, 0.08, 1.5, 0.6, 0, 2.5, 0.5, false, 0.5, false},
};
enum { LAYERS = sizeof layers / sizeof *layers };

static double end_of(const struct layer *layer)
{
    return layer->periodic ? 0.25 : layer->wall;
}

static struct layer_mode modes[LAYERS];

static int find_modes(void **state)
{
    (void)state;
    for (int l = 0; l < LAYERS; l++)
        if (!layer_mode_find(&layers[l], &modes[l])) return 1;
    return 0;
}

TEST(units_are_those_of_the_header)
{
    for (int l = 0; l < LAYERS; l++) {
        const struct layer_mode mode = modes[l];
        double v = 0, xi = 0;
        for (int i = 0; i <= 2000; i++) {
            const struct layer_amplitude a =
                layer_mode_amplitude(&mode, end_of(&layers[l]) * (i - 1000) / 1000);
            v = fmax(v, cabs(a.v)), xi = fmax(xi, cabs(a.xi));
        }
        near_relative(v, 1, 1e-13);
        near_relative(mode.displacement, xi, 1e-13);
        const double complex middle = layer_mode_amplitude(&mode, 0).v;
        assert_true(creal(middle) > 0);
        near_below(fabs(cimag(middle)), 1e-13);
        for (int i = 0; i < 20; i++) {
            const double x = 0.1 * i - 0.7, y = 0.02 * i - 0.2, t = 0.13 * i;
            const struct layer_amplitude a = layer_mode_amplitude(&mode, y);
            const struct layer_values s = layer_mode_values(&mode, x, y, t);
            const double complex wave = exp(cimag(mode.omega) * t) *
                                        cexp(LAYER_I * (layers[l].k * x - creal(mode.omega) * t));
            near_below(fabs(s.rho - creal(a.rho * wave)), 1e-13 * cabs(a.rho * wave));
            near_below(fabs(s.v[0] - creal(a.u * wave)), 1e-13 * cabs(a.u * wave));
            near_below(fabs(s.v[1] - creal(a.v * wave)), 1e-13 * cabs(a.v * wave));
            near_below(fabs(s.p - creal(a.p * wave)), 1e-13 * cabs(a.p * wave));
        }
    }
}

/* Gas without a layer has no growing mode, by either method; nor do waves much shorter than the
 * layer's thickness. */
TEST(nothing_grows)
{
    const struct layer still[] = {{1.4, 3, 0.2, 1.3, 0, 0, 1.7, 0, false, 0.6, false},
                                  {1.4, 60, 0.1, 1.5, 0.2, 0.3, 2.5, 0, false, 0.5, false}};
    for (int k = 0; k < 2; k++) {
        struct layer_mode mode;
        assert_false(layer_mode_find(&still[k], &mode));
    }
    assert_true(!(cimag(layer_mode_collocation(&still[0], 16)) >= 1e-6));
}

/* The unit of time is multiplied by 2^e and that of density by 2^b. */
TEST(units_do_not_matter)
{
    static const struct {
        int layer, e, b;
    } rows[] = {{1, 20, -30}, {3, -20, 30}};
    for (int k = 0; k < 2; k++) {
        const int e = rows[k].e, b = rows[k].b;
        const struct layer_mode *usual = &modes[rows[k].layer];
        struct layer layer = layers[rows[k].layer];
        struct layer_mode mode;
        layer.U = ldexp(layer.U, e), layer.g = ldexp(layer.g, 2 * e);
        layer.P = ldexp(layer.P, 2 * e + b);
        layer.rho = ldexp(layer.rho, b), layer.rho_step = ldexp(layer.rho_step, b);
        assert_true(layer_mode_find(&layer, &mode));
        near_below(cabs(mode.omega / ldexp(1, e) / usual->omega - 1), 1e-13);
        for (int i = -4; i <= 4; i++) {
            const double y = 0.23 * i * end_of(&layer);
            const struct layer_amplitude have = layer_mode_amplitude(&mode, y),
                                         want = layer_mode_amplitude(usual, y);
            near_below(cabs(have.v - want.v), 1e-12);
            near_below(cabs(have.p / ldexp(1, e + b) - want.p), 1e-12);
        }
    }
}

/* With weak gravity gas is nearly incompressible: the growth rate is proportional to the root of
 * gravity. A growth time of 1e8 sound times is below round-off. */
TEST(precision_of_slow_growth)
{
    struct layer layer = layers[4];
    struct layer_mode mode;
    const double rate = layer.k * sqrt(layer.gamma * layer.P / layer.rho);
    layer.g = 1e-8;
    assert_true(layer_mode_find(&layer, &mode));
    const double least = layer.g * pow(1e-8 * rate / cimag(mode.omega), 2);
    layer.g = 1.01 * least;
    assert_true(layer_mode_find(&layer, &mode));
    near_relative(cimag(mode.omega), 1e-8 * rate * sqrt(1.01), 1e-7);
    layer.g = 0.99 * least;
    assert_false(layer_mode_find(&layer, &mode));
}

TEST_BETWEEN(find_modes, NULL);
