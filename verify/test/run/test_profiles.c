/* SPDX-License-Identifier: GPL-3.0-or-later
 * Vortices and shear layers as their papers have them, written a second time; their mode's
 * amplitude and its table. */
#include "test.h"

#include <stdbool.h>

#include "kelvin_helmholtz.h"
#include "vortex.h"

/* McNally, Lyra & Passy 2012, eqs 1 and 3: 1.5 in the middle of a layer, half a unit away from it
 * by one exponential on each side. */
TEST(layers)
{
    for (int i = 0; i <= 1000; i++) {
        const double y = i / 1000., away = fmin(fabs(y - 0.25), fabs(y - 0.75));
        const double part = exp(-40 * away);
        const bool inside = y > 0.25 && y < 0.75;
        const struct kelvin_helmholtz_state s = kelvin_helmholtz_start(0.07 + 0.0007 * i, y);
        near_relative(s.rho, inside ? 2 - 0.5 * part : 1 + 0.5 * part, 1e-13);
        near_absolute(s.v[0] + 1, inside ? 0.5 + 0.5 * part : 1.5 - 0.5 * part, 1e-13);
        near_absolute(s.v[1] + 1, 1 + 0.01 * sin(4 * M_PI * (0.07 + 0.0007 * i)), 1e-15);
        assert_true(s.P == 2.5);
    }
}

/* Their eqs 6 to 9, at points that lie anywhere. */
TEST(amplitude)
{
    enum { N = 200 };
    double x[N], y[N], v[N], w[N], sums[3] = {0};
    for (int i = 0; i < N; i++) {
        x[i] = fmod(0.6180339887 * i, 1);
        y[i] = fmod(0.7548776662 * i + 0.01, 1);
        v[i] = 0.02 * sin(4 * M_PI * x[i] + 0.7) + 1e-3 * cos(7 * i);
        w[i] = 0.004 + 0.001 * sin(3 * i);
        const double E = exp(-4 * M_PI * (y[i] < 0.5 ? fabs(y[i] - 0.25) : fabs(1 - y[i] - 0.25)));
        sums[0] += w[i] * v[i] * sin(4 * M_PI * x[i]) * E;
        sums[1] += w[i] * v[i] * cos(4 * M_PI * x[i]) * E;
        sums[2] += w[i] * E;
    }
    near_relative(kelvin_helmholtz_amplitude(N, x, y, v, w),
                  2 * sqrt(sums[0] * sums[0] + sums[1] * sums[1]) / sums[2], 1e-13);
}

enum { ROWS = 16 };

/* At its times the table itself; between them a natural spline of its logarithms, solved here by
 * elimination; elsewhere nothing. */
TEST(table)
{
    const double amplitudes[] = {
#define ROW(t, M) M,
#include "kelvin_helmholtz.def"
#undef ROW
    };
    double f[ROWS], curved[ROWS] = {0}, diagonal[ROWS], right[ROWS];
    assert_int_equal(sizeof amplitudes / sizeof *amplitudes, ROWS);
    for (int i = 0; i < ROWS; i++) {
        f[i] = log(amplitudes[i]);
        near_relative(kelvin_helmholtz_reference(i == ROWS - 1 ? 1.5 : i / 10.), amplitudes[i],
                      1e-13);
    }
    /* second derivatives c: c[i-1] + 4 c[i] + c[i+1] = 6 (f[i-1] - 2 f[i] + f[i+1])/h^2, 0 at both
     * ends */
    for (int i = 1; i < ROWS - 1; i++) {
        diagonal[i] = 4 - (i > 1 ? 1 / diagonal[i - 1] : 0);
        right[i] =
            600 * (f[i - 1] - 2 * f[i] + f[i + 1]) - (i > 1 ? right[i - 1] / diagonal[i - 1] : 0);
    }
    for (int i = ROWS - 2; i > 0; i--) curved[i] = (right[i] - curved[i + 1]) / diagonal[i];
    for (int i = 0; i < ROWS - 1; i++)
        for (int k = 1; k < 4; k++) {
            const double a = k / 4., b = 1 - a;
            const double value =
                b * f[i] + a * f[i + 1] +
                ((b * b * b - b) * curved[i] + (a * a * a - a) * curved[i + 1]) / 600;
            near_relative(kelvin_helmholtz_reference((i + a) / 10), exp(value), 1e-12);
        }
    assert_true(isnan(kelvin_helmholtz_reference(-1e-9)));
    assert_true(isnan(kelvin_helmholtz_reference(1.5 + 1e-9)));
    assert_true(isnan(kelvin_helmholtz_reference((double)NAN)));
}

/* Gresho & Chan 1990: rho = 1, a triangle of velocity, and the pressure that holds it:
 * P(R) = 5 + integral of v^2/R, here by Simpson's rule between the corners. */
TEST(triangle)
{
    double held = 5;
    for (int i = 0; i < 60; i++) {
        const double R = i / 100., half = R + 0.005, next = R + 0.01;
        const struct vortex_state a = vortex_gresho(R), b = vortex_gresho(half),
                                  c = vortex_gresho(next);
        near_relative(a.P, held, 1e-8);
        assert_true(a.rho == 1 && b.rho == 1 && c.rho == 1);
        near_absolute(b.v + 1, 1 + fmax(0, fmin(5 * half, 2 - 5 * half)), 1e-14);
        const double slope[] = {R > 0 ? a.v * a.v / R : 0, b.v * b.v / half, c.v * c.v / next};
        held += 0.01 / 6 * (slope[0] + 4 * slope[1] + slope[2]);
    }
    near_relative(vortex_gresho(0.4).P, 3 + 4 * log(2), 1e-14);
    near_relative(vortex_gresho(2).P, 3 + 4 * log(2), 1e-14);
}
