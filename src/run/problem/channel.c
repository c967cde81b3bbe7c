/* SPDX-License-Identifier: GPL-3.0-or-later
 * A viscous liquid between plates at the y ends of the box, for other codes. It is at rest at t =
 * 0. Then the upper plate moves along x with `speed` (Couette), gravity along x drives the liquid
 * (Poiseuille), or both, since the equations are linear here (Morris, Fox & Zhu 1997). */
#include <math.h>

#include "initial.h"
#include "liquid.h"
#include "liquid_problem.h"

struct channel {
    struct liquid liquid;
    double height, speed, nu;
};
PROBLEM_OWN(channel)

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct channel *of = (struct channel *)p->own.bytes;
    *of = (struct channel){liquid_of(settings), domain_length(&p->domain, 1),
                           settings_real(settings, SETTING_speed),
                           settings_real(settings, SETTING_nu)};
    if (!(of->nu > 0))
        return error_set(error, STATUS_BAD_INPUT,
                         "nu=0: nothing drives the liquid; allowed: a viscosity above 0");
    if (p->gravity[1] != 0 || p->gravity[2] != 0)
        return error_set(error, STATUS_BAD_INPUT,
                         "gravity=\"%g %g %g\": allowed: along x, the direction of a channel",
                         p->gravity[0], p->gravity[1], p->gravity[2]);
    if (of->speed != 0 || p->gravity[0] != 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "speed=0 and no gravity along x: the liquid stays at rest");
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct channel *of = channel_of(p);
    const double y = fmin(fmax((x[1] - p->domain.lo[1]) / of->height, 0), 1);
    const double unit = of->height * of->height / of->nu;
    *state = liquid_state(&of->liquid, p->gamma);
    if (of->speed != 0) state->v[0] += of->speed * liquid_couette(y, t / unit);
    if (p->gravity[0] != 0) state->v[0] += p->gravity[0] * unit * liquid_poiseuille(y, t / unit);
}

/* Mean speed along the channel: the flow rate over the height. */
static double flow_measured(const struct prepared *p, const struct snapshot *s)
{
    return functional_window_mean(p, s, s->v[0]);
}

static double flow_exact(const struct prepared *p, double t)
{
    const struct channel *of = channel_of(p);
    const double unit = of->height * of->height / of->nu;
    return of->speed * liquid_couette_mean(t / unit) +
           p->gravity[0] * unit * liquid_poiseuille_mean(t / unit);
}

static const struct functional flow = {"channel_flow", NULL, flow_measured, flow_exact};

const struct problem problem_channel = {
    .member = {"channel", "a viscous liquid between plates", "Morris, Fox & Zhu 1997"},
    .reference = "channel",
    .least_dim = 2,
    .most_dim = 3,
    .smooth = true,
    .heavy = true,
    .liquid = true,
    .unknown = LIQUID_UNKNOWN,
    .ends = {{0}, {BOUNDARY_REFLECTING, PROBLEM_END(FIXED) | PROBLEM_END(OPEN)}, {0}},
    PROBLEM_KEYS(LIQUID_KEYS, {SETTING_nu, ROLE_NEEDED}, {SETTING_speed, ROLE_NEEDED}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&flow},
};
