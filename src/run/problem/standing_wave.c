/* SPDX-License-Identifier: GPL-3.0-or-later
 * A standing wave of small amplitude on a liquid under gravity along y, for other codes. The bottom
 * is at the lower end of the box, the mean surface at the upper end. At t = 0 the surface is flat
 * and moves upwards with amplitude depth omega cos(k x), k = 2 pi waves/L. Velocities evolve as
 * cos(omega t) exp(-2 nu k^2 t), omega^2 = g k tanh(k depth) (Lamb 1932, sections 228 and 348;
 * linear theory, so exact up to a fraction k depth amplitude and for small viscosity). */
#include <math.h>

#include "initial.h"
#include "liquid.h"
#include "liquid_problem.h"

struct wave {
    struct liquid liquid;
    double k, depth, omega, speed, nu; /* speed: of the surface */
};
PROBLEM_OWN(wave)

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct wave *of = (struct wave *)p->own.bytes;
    if (liquid_check_gravity(p, settings, error)) return error->status;
    const double depth = domain_length(&p->domain, 1), g = -p->gravity[1];
    const double k =
        2 * M_PI * settings_real(settings, SETTING_waves) / domain_length(&p->domain, 0);
    const double amplitude = settings_real(settings, SETTING_amplitude);
    if (!(amplitude > 0))
        return error_set(error, STATUS_BAD_INPUT, "amplitude=0: there is no wave");
    *of = (struct wave){.liquid = liquid_of(settings),
                        .k = k,
                        .depth = depth,
                        .omega = liquid_wave_frequency(k, depth, g),
                        .nu = settings_real(settings, SETTING_nu)};
    of->speed = amplitude * depth * of->omega;
    return STATUS_OK;
}

static void mode(const struct prepared *p, const double x[3], double v[3])
{
    const struct wave *of = wave_of(p);
    liquid_wave_mode(of->k, of->depth, x[0] - p->domain.lo[0], x[1] - p->domain.lo[1], v);
}

/* Amplitude of the mode relative to the start. */
static double amplitude_exact(const struct prepared *p, double t)
{
    const struct wave *of = wave_of(p);
    return cos(of->omega * t) * exp(-2 * of->nu * of->k * of->k * t);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct wave *of = wave_of(p);
    const double speed = of->speed * amplitude_exact(p, t);
    *state = liquid_state(&of->liquid, p->gamma);
    mode(p, x, state->v);
    for (int d = 0; d < 2; d++) state->v[d] *= speed;
}

static double amplitude_measured(const struct prepared *p, const struct snapshot *s)
{
    return liquid_amplitude(p, s, mode) / wave_of(p)->speed;
}

static const struct functional amplitude = {"wave_amplitude", NULL, amplitude_measured,
                                            amplitude_exact};

const struct problem problem_standing_wave = {
    .member = {"standing_wave", "a standing gravity wave on a liquid", "Lamb 1932"},
    .reference = "standing_wave",
    .least_dim = 2,
    .most_dim = 3,
    .smooth = true,
    .heavy = true,
    .liquid = true,
    .unknown = LIQUID_UNKNOWN,
    .ends = {PROBLEM_WALLS,
             {BOUNDARY_REFLECTING, PROBLEM_END(FIXED) | PROBLEM_END(OPEN)},
             {.also = PROBLEM_END(REFLECTING)}},
    PROBLEM_KEYS(LIQUID_KEYS, {SETTING_nu, ROLE_OPTIONAL}, {SETTING_amplitude, ROLE_NEEDED},
                 {SETTING_waves, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&amplitude},
};
