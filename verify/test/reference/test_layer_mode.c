/* SPDX-License-Identifier: GPL-3.0-or-later
 * The mode of a layer that grows fastest: it solves the linearised equations, keeps to the ends of
 * its layer and to its mirror images, has its unit, and grows as fast as eigenvalues say. */
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

/* By differences of eighth order; none is smaller than round-off lets it be. */
static double complex slope(const struct layer_mode *mode, double y, bool of_v)
{
    static const double weights[] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
    const double step = 0.02 * mode->layer.width;
    double complex sum = 0;
    for (int i = 1; i <= 4; i++) {
        const struct layer_amplitude a = layer_mode_amplitude(mode, y + i * step),
                                     b = layer_mode_amplitude(mode, y - i * step);
        sum += weights[i - 1] * (of_v ? a.v - b.v : a.p - b.p);
    }
    return sum / step;
}

TEST(equations_hold)
{
    for (int l = 0; l < LAYERS; l++) {
        const struct layer *layer = &layers[l];
        const struct layer_mode mode = modes[l];
        for (int i = -40; i <= 40; i++) {
            const double y = 0.0211 * end_of(layer) * i;
            const struct layer_base b = layer_base(layer, y);
            const struct layer_amplitude a = layer_mode_amplitude(&mode, y);
            const double complex s = layer->k * b.U - mode.omega, v_dy = slope(&mode, y, true),
                                 p_dy = slope(&mode, y, false);
            const double complex flow = LAYER_I * layer->k * a.u + v_dy;
            near_below(cabs(a.v - LAYER_I * s * a.xi), 1e-13 * cabs(a.v) + 1e-15);
            near_below(cabs(LAYER_I * s * a.rho + a.v * b.rho_dy + b.rho * flow), 1e-7);
            near_below(cabs(LAYER_I * s * a.u + a.v * b.U_dy + LAYER_I * layer->k * a.p / b.rho),
                       1e-7);
            near_below(cabs(LAYER_I * s * a.v + (p_dy + layer->g * a.rho) / b.rho), 1e-7);
            near_below(cabs(LAYER_I * s * a.p - a.v * b.rho * layer->g + layer->gamma * b.P * flow),
                       1e-7);
        }
        const struct layer_amplitude low = layer_mode_amplitude(&mode, -end_of(layer)),
                                     high = layer_mode_amplitude(&mode, end_of(layer));
        for (int k = 0; k < 2; k++) {
            const struct layer_amplitude *a = k ? &high : &low;
            near_below(cabs(layer->pressure_node ? a->p : a->v), 1e-9);
            assert_true(cabs(layer->pressure_node ? a->v : a->p) > 1e-3);
        }
    }
}

/* Eigenvalues at points share no method with the shooting. */
TEST(growth_is_that_of_eigenvalues)
{
    for (int l = 0; l < LAYERS; l++) {
        const struct layer_mode mode = modes[l];
        const double complex other = layer_mode_collocation(&layers[l], 48);
        assert_true(cimag(mode.omega) > 0.1);
        near_below(cabs(other / mode.omega - 1), 1e-9);
        /* few points know it already: the search starts there */
        near_below(cabs(layer_mode_collocation(&layers[l], 32) / mode.omega - 1), 1e-2);
    }
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

/* About y = 1/4 of a periodic layer: where the pressure has its node there it is odd, and so is all
 * but v; elsewhere v is. The period is 1. */
TEST(images_are_mirrored)
{
    for (int l = 0; l < 2; l++) {
        const struct layer_mode mode = modes[l];
        const double rest = layers[l].pressure_node ? -1 : 1;
        for (int i = -24; i <= 24; i++) {
            const double y = 0.01 * i;
            const struct layer_amplitude a = layer_mode_amplitude(&mode, y);
            for (int k = -1; k <= 1; k++) {
                const struct layer_amplitude b = layer_mode_amplitude(&mode, 0.5 - y + k),
                                             c = layer_mode_amplitude(&mode, y + k);
                near_below(cabs(b.rho - rest * a.rho), 1e-10);
                near_below(cabs(b.u - rest * a.u), 1e-10);
                near_below(cabs(b.p - rest * a.p), 1e-10);
                near_below(cabs(b.v + rest * a.v), 1e-10);
                near_below(cabs(b.xi + rest * a.xi), 1e-10);
                near_below(cabs(c.rho - a.rho) + cabs(c.u - a.u) + cabs(c.v - a.v) +
                               cabs(c.p - a.p) + cabs(c.xi - a.xi),
                           1e-10);
            }
        }
    }
}

/* Gas without a layer has no growing mode, by either method; nor have waves that are much shorter
 * than their layer is thick. */
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

/* With units of time that are 2^e times as long, and of density, 2^b times as much. */
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

/* Weak gravity moves gas as slowly as it does where nothing is compressed: the growth goes with its
 * root. What would take 1e8 sound times is round-off. */
TEST(slow_growth_is_known_as_far_as_it_can_be)
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
