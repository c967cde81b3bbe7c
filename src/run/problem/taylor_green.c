/* SPDX-License-Identifier: GPL-3.0-or-later
 * Taylor-Green vortices in a periodic square of a viscous liquid, for other codes: vx = speed sin(k
 * x) cos(k y), vy = -speed cos(k x) sin(k y), both times exp(-2 nu k^2 t), k = 2 pi waves/L, x and
 * y from the lower ends of the box. An exact solution of the incompressible Navier-Stokes equations
 * (Taylor & Green 1937). `vortex_decay` is -ln A/t, where A is the projection of the velocity on
 * the initial flow, relative to its initial value. */
#include <math.h>

#include "initial.h"
#include "liquid_problem.h"

struct vortices {
    struct liquid liquid;
    double k, speed, nu;
};
PROBLEM_OWN(vortices)

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct vortices *of = (struct vortices *)p->own.bytes;
    const double length = domain_length(&p->domain, 0), height = domain_length(&p->domain, 1);
    *of = (struct vortices){
        liquid_of(settings), 2 * M_PI * settings_real(settings, SETTING_waves) / length,
        settings_real(settings, SETTING_speed), settings_real(settings, SETTING_nu)};
    if (of->speed == 0) return error_set(error, STATUS_BAD_INPUT, "speed=0: there are no vortices");
    if (fabs(length - height) <= 1e-12 * length) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "a box of %g by %g: the vortices are squares; allowed: sides of one length",
                     length, height);
}

/* The initial flow with speed 1. */
static void mode(const struct prepared *p, const double x[3], double v[3])
{
    const double k = vortices_of(p)->k;
    const double a = k * (x[0] - p->domain.lo[0]), b = k * (x[1] - p->domain.lo[1]);
    v[0] = sin(a) * cos(b);
    v[1] = -cos(a) * sin(b);
}

static double decay(const struct prepared *p, double t)
{
    (void)t;
    return 2 * vortices_of(p)->nu * vortices_of(p)->k * vortices_of(p)->k;
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct vortices *of = vortices_of(p);
    const double speed = of->speed * exp(-decay(p, t) * t);
    *state = liquid_state(&of->liquid, p->gamma);
    mode(p, x, state->v);
    for (int d = 0; d < 2; d++) state->v[d] *= speed;
}

static double amplitude_measured(const struct prepared *p, const struct snapshot *s)
{
    return liquid_amplitude(p, s, mode) / vortices_of(p)->speed;
}

static double amplitude_exact(const struct prepared *p, double t)
{
    return exp(-decay(p, t) * t);
}

/* The exact rate at the start, where nothing has decayed yet. */
static double decay_measured(const struct prepared *p, const struct snapshot *s)
{
    return s->time > 0 ? -log(amplitude_measured(p, s)) / s->time : decay(p, 0);
}

static const struct functional amplitude = {"vortex_amplitude", NULL, amplitude_measured,
                                            amplitude_exact},
                               rate = {"vortex_decay", NULL, decay_measured, decay};

const struct problem problem_taylor_green = {
    .member = {"taylor_green", "vortices that viscosity slows down", "Taylor & Green 1937"},
    .reference = "taylor_green",
    .least_dim = 2,
    .most_dim = 2,
    .carried = true,
    .smooth = true,
    .liquid = true,
    .unknown = LIQUID_UNKNOWN,
    PROBLEM_KEYS(LIQUID_KEYS, {SETTING_nu, ROLE_NEEDED}, {SETTING_speed, ROLE_OPTIONAL},
                 {SETTING_waves, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&amplitude, &rate},
};
