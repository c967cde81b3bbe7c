/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "functional.h"

#include <math.h>

const char *const run_functional_names[RUN_FUNCTIONALS] = {
#define F(name) #name,
    RUN_FUNCTIONAL_LIST(F)
#undef F
};

enum { MODE_POINTS = 1024 };

/* Mean of a particle field over the window, weighted with volume. */
static double window_mean(const struct run_result *result, const double *field)
{
    const struct snapshot *s = &result->snapshot;
    double sum = 0, volume = 0;
    for (size_t i = 0; i < s->n; i++)
        if (s->x[0][i] >= result->window[0] && s->x[0][i] <= result->window[1]) {
            sum += s->volume[i] * field[i];
            volume += s->volume[i];
        }
    return sum / volume;
}

static struct run_functional mean_of(const struct run_result *result, const char *name,
                                     enum field field, const double *values)
{
    struct run_functional mean = {.name = name, .value = window_mean(result, values)};
    exact_means(&result->exact, field, result->time, result->window, 1, &mean.exact);
    return mean;
}

/* Where the pressure, seen from the right, first passes the mean of both sides of the shock. */
static struct run_functional shock_position(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    const struct riemann_solution *tube = &result->exact.tube;
    const double level = 0.5 * (tube->p_star + tube->right.P);
    struct run_functional position = {run_functional_names[RUN_shock_position], NAN,
                                      result->exact.x0 + tube->right_head * result->time};
    for (size_t i = s->n; i-- > 1;) {
        const double x0 = s->x[0][i - 1], x1 = s->x[0][i], p0 = s->P[i - 1], p1 = s->P[i];
        if (!(x1 <= result->window[1] && p0 >= level && p1 < level)) continue;
        position.value = x0 + (x1 - x0) * (p0 - level) / (p0 - p1);
        break;
    }
    return position;
}

/* Sums of a mode: cosine, sine, volume. */
struct mode {
    double a, b, volume;
};

static void mode_add(struct mode *mode, const struct exact *exact, double x, double volume,
                     double rho)
{
    const double phase = 2 * M_PI * (x - exact->lo) / exact->wave.length;
    mode->a += volume * (rho - exact->wave.rho0) * cos(phase);
    mode->b += volume * (rho - exact->wave.rho0) * sin(phase);
    mode->volume += volume;
}

/* Amplitude of the density's first Fourier mode, relative to the background. */
static struct run_functional mode_amplitude(const struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    const struct exact *exact = &result->exact;
    const double step = (exact->hi - exact->lo) / MODE_POINTS;
    struct mode measured = {0}, true_mode = {0};
    for (size_t i = 0; i < s->n; i++)
        mode_add(&measured, exact, s->x[0][i], s->volume[i], s->rho[i]);
    for (int i = 0; i < MODE_POINTS; i++) { /* smooth and periodic: converges at once */
        const double x = exact->lo + (i + 0.5) * step;
        double values[FIELDS];
        exact_sample(exact, x, result->time, values);
        mode_add(&true_mode, exact, x, step, values[FIELD_DENSITY]);
    }
    const double rho0 = exact->wave.rho0;
    return (struct run_functional){run_functional_names[RUN_mode_amplitude],
                                   2 * hypot(measured.a, measured.b) / measured.volume / rho0,
                                   2 * hypot(true_mode.a, true_mode.b) / true_mode.volume / rho0};
}

void functional_measure(struct run_result *result)
{
    const struct snapshot *s = &result->snapshot;
    struct run_functional *f = result->functionals;
    result->h = window_mean(result, s->h);
    *f++ = mean_of(result, run_functional_names[RUN_mean_internal_energy], FIELD_INTERNAL_ENERGY,
                   s->u);
    *f++ = mean_of(result, run_functional_names[RUN_mean_pressure], FIELD_PRESSURE, s->P);
    if (result->exact.kind == KIND_SOUND_WAVE)
        *f++ = mode_amplitude(result);
    else if (result->exact.tube.right_wave == RIEMANN_SHOCK)
        *f++ = shock_position(result);
    result->functional_count = (size_t)(f - result->functionals);
}
