/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "functional.h"

#include <math.h>

double functional_window_mean(const struct prepared *p, const struct snapshot *s,
                              const double *field)
{
    double sum = 0, volume = 0, x[3];
    for (size_t i = 0; i < s->n; i++) {
        problem_position(p, s, i, x);
        if (!window_contains(&p->window, x)) continue;
        sum += s->volume[i] * field[i];
        volume += s->volume[i];
    }
    return sum / volume;
}

static bool on_a_line(const struct prepared *p)
{
    return p->domain.dim == 1;
}

static double exact_mean(const struct prepared *p, enum field field, double t)
{
    double mean;
    problem_means(p, field, t, 1, &mean);
    return mean;
}

static double energy_measured(const struct prepared *p, const struct snapshot *s)
{
    return functional_window_mean(p, s, s->u);
}

static double energy_exact(const struct prepared *p, double t)
{
    return exact_mean(p, FIELD_INTERNAL_ENERGY, t);
}

static double pressure_measured(const struct prepared *p, const struct snapshot *s)
{
    return functional_window_mean(p, s, s->P);
}

static double pressure_exact(const struct prepared *p, double t)
{
    return exact_mean(p, FIELD_PRESSURE, t);
}

const struct functional functional_mean_internal_energy = {"mean_internal_energy", on_a_line,
                                                           energy_measured, energy_exact};
const struct functional functional_mean_pressure = {"mean_pressure", on_a_line, pressure_measured,
                                                    pressure_exact};

static double velocity_measured(const struct prepared *p, const struct snapshot *s)
{
    double sum = 0, volume = 0;
    for (size_t i = 0; i < s->n; i++) {
        double x[3], v[3];
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        if (!window_contains(&p->window, x)) continue;
        const double squares = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        sum += s->volume[i] * squares * s->rho[i] / (p->gamma * s->P[i]);
        volume += s->volume[i];
    }
    return sqrt(sum / volume);
}

double functional_zero(const struct prepared *p, double t)
{
    (void)p, (void)t;
    return 0;
}

double functional_one(const struct prepared *p, double t)
{
    (void)p, (void)t;
    return 1;
}

const struct functional functional_velocity_rms = {"velocity_rms", NULL, velocity_measured,
                                                   functional_zero};
