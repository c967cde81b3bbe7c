/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simple_wave.h"

#include <math.h>
#include <stddef.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>

static const double undefined = (double)NAN;

static double sound_speed(const struct simple_wave *wave)
{
    return sqrt(wave->gamma * wave->P0 / wave->rho0);
}

/* v + c - (v0 + c0) of the value that starts at x, without cancellation for small amplitudes. */
static double excess_speed(const struct simple_wave *wave, double x)
{
    const double gamma = wave->gamma;
    const double swell = wave->amplitude * sin(2 * M_PI * x / wave->length);
    return sound_speed(wave) * (gamma + 1) / (gamma - 1) * expm1((gamma - 1) / 2 * log1p(swell));
}

const char *simple_wave_fault(const struct simple_wave *wave)
{
    if (!(wave->gamma > 1) || !isfinite(wave->gamma)) return "gamma must be finite and above 1";
    if (!(wave->rho0 > 0) || !isfinite(wave->rho0)) return "rho0 must be finite and above 0";
    if (!(wave->P0 > 0) || !isfinite(wave->P0)) return "P0 must be finite and above 0";
    if (!(wave->length > 0) || !isfinite(wave->length)) return "length must be finite and above 0";
    if (!(fabs(wave->amplitude) < 1)) return "amplitude must lie between -1 and 1";
    if (!isfinite(wave->v0)) return "v0 must be finite";
    return NULL;
}

/* 1/max(-d(v + c)/dx): the steepest place is where (1 + A s)^((gamma-3)/2) cos is extreme, with
 * s = sin a root of (gamma-1)/2 A s^2 + s - (gamma-3)/2 A = 0. */
double simple_wave_breaking_time(const struct simple_wave *wave)
{
    const double gamma = wave->gamma, A = fabs(wave->amplitude), k = 2 * M_PI / wave->length;
    const double s = (gamma - 3) * A / (1 + sqrt(1 + (gamma - 1) * (gamma - 3) * A * A));
    const double steepest = pow(1 + A * s, (gamma - 3) / 2) * sqrt((1 - s) * (1 + s));
    return 1 / ((gamma + 1) / 2 * sound_speed(wave) * k * A * steepest);
}

struct characteristic {
    const struct simple_wave *wave;
    double x, t;
};

static double miss(double start, void *parameters)
{
    const struct characteristic *c = parameters;
    return start + excess_speed(c->wave, start) * c->t - c->x;
}

/* Where the value now at x (in the frame that moves with v0 + c0) started. miss() grows with start
 * until the wave breaks; the bracket holds for every start, since the excess speed is bounded. */
static double characteristic_start(const struct simple_wave *wave, double x, double t)
{
    const double quarter = copysign(wave->length / 4, wave->amplitude);
    const double slowest = excess_speed(wave, -quarter), fastest = excess_speed(wave, quarter);
    const double margin = 1e-6 * wave->length;
    struct characteristic c = {wave, x, t};
    gsl_function f = {miss, &c};
    const double low = x - fastest * t - margin, high = x - slowest * t + margin;
    /* beyond the range of double; and GSL would abort */
    if (!(miss(low, &c) < 0 && miss(high, &c) > 0 && isfinite(high - low))) return undefined;
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    if (!solver) return undefined;
    double start = undefined;
    /* ends: at what is no number, or with Brent's bracket, which closes to GSL_DBL_EPSILON |root|
     */
    if (gsl_root_fsolver_set(solver, &f, low, high) == GSL_SUCCESS)
        while (gsl_root_fsolver_iterate(solver) == GSL_SUCCESS) {
            const double width =
                gsl_root_fsolver_x_upper(solver) - gsl_root_fsolver_x_lower(solver);
            start = gsl_root_fsolver_root(solver);
            if (!(width > 2 * GSL_DBL_EPSILON * (fabs(start) + wave->length))) break;
        }
    gsl_root_fsolver_free(solver);
    return start;
}

struct simple_wave_state simple_wave_sample(const struct simple_wave *wave, double x, double t)
{
    const double gamma = wave->gamma, c0 = sound_speed(wave);
    if (!isfinite(x) || !(t >= 0) || !(t < simple_wave_breaking_time(wave)))
        return (struct simple_wave_state){undefined, undefined, undefined, undefined};
    /* into the moving frame first, then into one period: keeps the digits at late times */
    const double moved = fmod(x - (wave->v0 + c0) * t, wave->length);
    const double start = characteristic_start(wave, moved, t);
    const double log_rho = log1p(wave->amplitude * sin(2 * M_PI * start / wave->length));
    struct simple_wave_state state = {
        .rho = wave->rho0 * exp(log_rho),
        .v = wave->v0 + 2 * c0 / (gamma - 1) * expm1((gamma - 1) / 2 * log_rho),
        .P = wave->P0 * exp(gamma * log_rho),
    };
    state.u = state.P / ((gamma - 1) * state.rho);
    return state;
}
