/* SPDX-License-Identifier: GPL-3.0-or-later
 * Compares series for flows between plates with other sums and with finite differences, and waves
 * on a liquid with the equations that they solve. */
#include "test.h"

#include "draw.h"
#include "liquid.h"

/* Couette flow from rest as images of the error function (Carslaw & Jaeger 1959, section 12.5). */
static double by_images(double y, double t)
{
    double sum = 0;
    for (int n = 0; n < 40; n++)
        sum += erfc((2 * n + 1 - y) / (2 * sqrt(t))) - erfc((2 * n + 1 + y) / (2 * sqrt(t)));
    return sum;
}

TEST(couette_by_images)
{
    for (int k = 0; k < 400; k++) {
        const double y = draw(0, 1), t = pow(10, draw(-7, 1));
        near_below(fabs(liquid_couette(y, t) - by_images(y, t)), 2e-14);
    }
    assert_true(liquid_couette(0.5, 0) == 0 && liquid_poiseuille(0.5, 0) == 0);
    near_below(fabs(liquid_couette(0.3, 100) - 0.3), 1e-15);
    near_below(fabs(liquid_poiseuille(0.3, 100) - 0.5 * 0.3 * 0.7), 1e-15);
}

/* Means by the midpoint rule. */
TEST(means)
{
    enum { PARTS = 4000 };
    for (int k = 0; k < 20; k++) {
        const double t = pow(10, draw(-4, 0.5));
        double couette = 0, poiseuille = 0;
        for (int i = 0; i < PARTS; i++) {
            couette += liquid_couette((i + 0.5) / PARTS, t) / PARTS;
            poiseuille += liquid_poiseuille((i + 0.5) / PARTS, t) / PARTS;
        }
        near_below(fabs(liquid_couette_mean(t) - couette), 1e-6);
        near_below(fabs(liquid_poiseuille_mean(t) - poiseuille), 1e-6 * t);
    }
    assert_true(liquid_couette_mean(0) == 0 && liquid_poiseuille_mean(0) == 0);
}

/* du/dt = d2u/dy2 + force, by Crank and Nicolson's method from rest, after steps of dt. */
enum { POINTS = 201 };
static void diffuse(double force, double wall, double dt, int steps, double u[POINTS])
{
    const double dy = 1. / (POINTS - 1), r = 0.5 * dt / (dy * dy);
    double up[POINTS], right[POINTS];
    for (int i = 0; i < POINTS; i++) u[i] = 0;
    for (int s = 0; s < steps; s++) {
        u[POINTS - 1] = wall;
        up[0] = right[0] = 0;
        for (int i = 1; i < POINTS - 1; i++) { /* Thomas' elimination */
            const double known = u[i] + r * (u[i - 1] - 2 * u[i] + u[i + 1]) + dt * force;
            const double pivot = 1 + 2 * r - r * up[i - 1];
            up[i] = r / pivot;
            right[i] = (known + r * right[i - 1]) / pivot;
        }
        for (int i = POINTS - 2; i > 0; i--) u[i] = right[i] + up[i] * u[i + 1];
    }
}

TEST(poiseuille_by_differences)
{
    static const double times[] = {0.02, 0.1, 0.5};
    for (size_t k = 0; k < sizeof times / sizeof *times; k++) {
        double u[POINTS];
        diffuse(1, 0, times[k] / 4000, 4000, u);
        for (int i = 0; i < POINTS; i++)
            near_below(fabs(liquid_poiseuille((double)i / (POINTS - 1), times[k]) - u[i]), 2e-6);
        diffuse(0, 1, times[k] / 4000, 4000, u);
        for (int i = 0; i < POINTS; i++)
            near_below(fabs(liquid_couette((double)i / (POINTS - 1), times[k]) - u[i]), 1e-3);
    }
}

/* The velocity is free of sources and of rotation, vanishes at the bottom along y, and obeys
 * omega^2 phi = g dphi/dy at the surface, where v = grad phi and phi = cosh(k y) cos(k x)/(k sinh(k
 * H)). */
TEST(waves)
{
    for (int round = 0; round < 200; round++) {
        const double k = draw(0.5, 8), depth = draw(0.2, 2), g = draw(0.5, 10), step = 1e-4;
        const double x = draw(-1, 1), y = draw(0, depth);
        double east[2], west[2], north[2], south[2], v[2];
        liquid_wave_mode(k, depth, x + step, y, east),
            liquid_wave_mode(k, depth, x - step, y, west);
        liquid_wave_mode(k, depth, x, y + step, north);
        liquid_wave_mode(k, depth, x, y - step, south);
        near_below(fabs(east[0] - west[0] + north[1] - south[1]) / step, 1e-4);
        near_below(fabs(east[1] - west[1] - north[0] + south[0]) / step, 1e-4);
        liquid_wave_mode(k, depth, x, 0, v);
        assert_true(v[1] == 0);
        liquid_wave_mode(k, depth, x, depth, v);
        near_below(fabs(v[1] - cos(k * x)), 1e-12);
        const double phi = cosh(k * depth) * cos(k * x) / (k * sinh(k * depth));
        const double omega = liquid_wave_frequency(k, depth, g);
        near_below(fabs(omega * omega * phi - g * v[1]), 1e-10 * g);
    }
}
