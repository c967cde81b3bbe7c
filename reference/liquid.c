/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "liquid.h"

#include <math.h>

/* A term of a series is negligible when exp(-over) is negligible beside 1. */
static const double over = 42;

/* Number of non-negligible terms exp(-(n pi)^2 t) at time t. */
static int waves_at(double t)
{
    enum { MOST = 1000000 }; /* at t = 4e-12: layers of 2e-6 of the width */
    const double n = sqrt(over / (M_PI * M_PI * t)) + 1;
    return n < MOST ? (int)n : MOST;
}

double liquid_couette(double y, double t)
{
    double sum = 0;
    if (!(t > 0)) return y < 1 ? 0 : 1;
    for (int n = waves_at(t); n > 0; n--) {
        const double k = n * M_PI;
        sum += (n % 2 ? -2 : 2) / k * sin(k * y) * exp(-k * k * t);
    }
    return y + sum;
}

double liquid_poiseuille(double y, double t)
{
    double sum = 0;
    if (!(t > 0)) return 0;
    for (int n = waves_at(t) | 1; n > 0; n -= 2) {
        const double k = n * M_PI;
        sum += 4 / (k * k * k) * sin(k * y) * exp(-k * k * t);
    }
    return 0.5 * y * (1 - y) - sum;
}

double liquid_couette_mean(double t)
{
    double sum = 0;
    if (!(t > 0)) return 0;
    for (int n = waves_at(t) | 1; n > 0; n -= 2) {
        const double k = n * M_PI;
        sum += 4 / (k * k) * exp(-k * k * t);
    }
    return 0.5 - sum;
}

double liquid_poiseuille_mean(double t)
{
    double sum = 0;
    if (!(t > 0)) return 0;
    for (int n = waves_at(t) | 1; n > 0; n -= 2) {
        const double k = n * M_PI;
        sum += 8 / (k * k * k * k) * exp(-k * k * t);
    }
    return 1. / 12 - sum;
}

double liquid_wave_frequency(double k, double depth, double gravity)
{
    return sqrt(gravity * k * tanh(k * depth));
}

void liquid_wave_mode(double k, double depth, double x, double y, double v[2])
{
    const double surface = sinh(k * depth);
    v[0] = -cosh(k * y) / surface * sin(k * x);
    v[1] = sinh(k * y) / surface * cos(k * x);
}
