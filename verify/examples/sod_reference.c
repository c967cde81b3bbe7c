/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sod's shock tube (gamma as the case has it) as a user's exact solution, for `reference =
 * ./sod_reference.so`, after Toro 2009, section 4. The parameter `slip` moves the contact: a wrong
 * solution. -DHARM=... does harm at t > 0, -DLATER=... only in the process that measures errors. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/time.h>
#include <unistd.h>

#include "reference.h"

static const double left[] = {1, 0, 1}, right[] = {0.125, 0, 0.1}; /* rho v P */

/* The change of velocity across a wave into this side, which leaves the pressure P. */
static double jump(const double side[3], double P, double g)
{
    const double c = sqrt(g * side[2] / side[0]);
    if (P <= side[2]) return 2 * c / (g - 1) * (pow(P / side[2], (g - 1) / (2 * g)) - 1);
    const double A = 2 / ((g + 1) * side[0]), B = (g - 1) / (g + 1) * side[2];
    return (P - side[2]) * sqrt(A / (P + B));
}

static int harm(double x)
{
    (void)x;
#ifdef HARM
    HARM;
#endif
#ifdef LATER
    struct itimerval timer; /* runs only in the process that tries the plug-in */
    getitimer(ITIMER_PROF, &timer);
    if (!timer.it_interval.tv_sec && !timer.it_interval.tv_usec) LATER;
#endif
    return 0;
}

int sphproof_reference(const double *x, double t, const struct sphproof_reference_case *of,
                       struct sphproof_reference_state *state)
{
    const double g = of->gamma, c = sqrt(g * left[2] / left[0]);
    double low = right[2], high = left[2];
    for (int i = 0; i < 60; i++) {
        const double P = 0.5 * (low + high);
        *(jump(left, P, g) + jump(right, P, g) > 0 ? &high : &low) = P;
    }
    const double P = 0.5 * (low + high), v = 0.5 * (jump(right, P, g) - jump(left, P, g));
    const double inner = left[0] * pow(P / left[2], 1 / g), tail = v - sqrt(g * P / inner);
    const double mach2 = (g + 1) / (2 * g) * (P / right[2] - 1) + 1;
    const double shock = sqrt(mach2 * g * right[2] / right[0]);
    const double ratio = (g + 1) * mach2 / ((g - 1) * mach2 + 2);
    const double contact = v + sphproof_reference_parameter(of, "slip", 0);
    const double middle = 0.5 * (of->lo[0] + of->hi[0]), xi = (x[0] - middle) / t;
    if (t > 0 && harm(x[0])) return 1;
    if (!(t > 0) ? x[0] < middle : xi < -c) {
        state->rho = left[0], state->v[0] = 0, state->P = left[2];
    } else if (t > 0 && xi < tail) {
        const double sound = 2 / (g + 1) * (c - (g - 1) / 2 * xi);
        state->rho = left[0] * pow(sound / c, 2 / (g - 1));
        state->v[0] = 2 / (g + 1) * (c + xi);
        state->P = left[2] * pow(sound / c, 2 * g / (g - 1));
    } else if (t > 0 && xi < shock) {
        state->rho = xi < contact ? inner : ratio * right[0];
        state->v[0] = v;
        state->P = P;
    } else {
        state->rho = right[0], state->v[0] = 0, state->P = right[2];
    }
    for (int d = 1; d < of->dim; d++) state->v[d] = 0;
    return 0;
}
