/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kelvin_helmholtz.h"

#include <gsl/gsl_spline.h>
#include <math.h>

/* Joins the value a outside the layers at 1/4 and 3/4 smoothly to b between them. */
static double joined(double y, double a, double b)
{
    const double width = 0.025, middle = 0.5 * (a - b);
    if (y < 0.25) return a - middle * exp((y - 0.25) / width);
    if (y < 0.5) return b + middle * exp((0.25 - y) / width);
    if (y < 0.75) return b + middle * exp((y - 0.75) / width);
    return a - middle * exp((0.75 - y) / width);
}

struct kelvin_helmholtz_state kelvin_helmholtz_start(double x, double y)
{
    return (struct kelvin_helmholtz_state){
        joined(y, 1, 2), {joined(y, 0.5, -0.5), 0.01 * sin(4 * M_PI * x)}, 2.5};
}

double kelvin_helmholtz_amplitude(unsigned long n, const double *x, const double *y,
                                  const double *vy, const double *w)
{
    double sine = 0, cosine = 0, weight = 0;
    for (unsigned long i = 0; i < n; i++) {
        const double E = w[i] * exp(-4 * M_PI * fabs(y[i] - (y[i] < 0.5 ? 0.25 : 0.75)));
        sine += vy[i] * sin(4 * M_PI * x[i]) * E;
        cosine += vy[i] * cos(4 * M_PI * x[i]) * E;
        weight += E;
    }
    return 2 * hypot(sine / weight, cosine / weight);
}

static const double times[] = {
#define ROW(t, M) t,
#include "kelvin_helmholtz.def"
#undef ROW
};
static const double amplitudes[] = {
#define ROW(t, M) M,
#include "kelvin_helmholtz.def"
#undef ROW
};
enum { ROWS = sizeof times / sizeof *times };

double kelvin_helmholtz_reference(double t)
{
    double logs[ROWS], log_M;
    for (int i = 0; i < ROWS; i++) logs[i] = log(amplitudes[i]);
    gsl_spline *spline = gsl_spline_alloc(gsl_interp_cspline, ROWS);
    if (!spline) return NAN;
    gsl_spline_init(spline, times, logs, ROWS);
    const int status = gsl_spline_eval_e(spline, t, NULL, &log_M); /* fails beyond the table */
    gsl_spline_free(spline);
    return status ? (double)NAN : exp(log_M);
}
