/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shells.h"

#include <math.h>

static double radius_of(const struct prepared *p, const struct snapshot *s, size_t i)
{
    double x[3];
    problem_position(p, s, i, x);
    return problem_radius(p, x);
}

/* Mean spacing of the particles in the window. */
static double mean_spacing(const struct prepared *p, const struct snapshot *s)
{
    double volume = 0, count = 0;
    for (size_t i = 0; i < s->n; i++) {
        double x[3];
        problem_position(p, s, i, x);
        if (!window_contains(&p->window, x)) continue;
        volume += s->volume[i];
        count++;
    }
    return pow(volume / count, 1. / p->domain.dim);
}

void shells_make(struct shells *shells, const struct prepared *p, const struct snapshot *s)
{
    double mass[SHELLS_MAX] = {0}, volume[SHELLS_MAX] = {0};
    const double reach = 0.5 * domain_shortest(&p->domain);
    shells->width = mean_spacing(p, s);
    shells->n = 0;
    if (!(shells->width > 0)) return; /* no particle in the window */
    shells->width = fmax(shells->width, reach / SHELLS_MAX);
    shells->n = (size_t)fmin(SHELLS_MAX, ceil(reach / shells->width));
    for (size_t i = 0; i < s->n; i++) {
        const double shell = floor(radius_of(p, s, i) / shells->width);
        if (!(shell < (double)shells->n)) continue;
        mass[(size_t)shell] += s->m[i];
        volume[(size_t)shell] += s->volume[i];
    }
    for (size_t k = 0; k < shells->n; k++) shells->density[k] = mass[k] / volume[k];
}

double shells_peak(const struct shells *shells)
{
    double peak = NAN;
    for (size_t k = 0; k < shells->n; k++) peak = fmax(peak, shells->density[k]);
    return peak;
}

double shells_crossing(const struct shells *shells, double level)
{
    size_t outer = shells->n;
    for (size_t k = shells->n; k-- > 0;) {
        const double here = shells->density[k];
        if (isnan(here)) continue; /* interpolate across an empty shell */
        if (here >= level && outer < shells->n) {
            const double out = shells->density[outer];
            const double part = (here - level) / (here - out);
            return ((double)k + 0.5 + part * (double)(outer - k)) * shells->width;
        }
        outer = k;
    }
    return NAN;
}

double shells_mean(const struct prepared *p, const struct snapshot *s, double lo, double hi)
{
    double mass = 0, volume = 0;
    for (size_t i = 0; i < s->n; i++) {
        const double r = radius_of(p, s, i);
        if (!(r >= lo && r < hi)) continue;
        mass += s->m[i];
        volume += s->volume[i];
    }
    return mass / volume;
}
