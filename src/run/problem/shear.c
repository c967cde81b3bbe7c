/* SPDX-License-Identifier: GPL-3.0-or-later
 * Layers that slide past each other: v = v0 sin(2 pi s/L) normal to the direction s, in gas of
 * uniform density and pressure. Without viscosity the flow is steady (Landau & Lifshitz 1987,
 * section 2: the pressure is uniform); with a viscosity nu the wave decays at the rate nu (2
 * pi/L)^2. Particles of equal masses. */
#include <math.h>
#include <string.h>

#include "functional.h"
#include "initial.h"
#include "problem.h"

static const double speed = 0.5;

struct layers {
    double n[3], flow[3]; /* unit vectors: direction in which v changes, direction of v */
    double length;
    double gas[3]; /* rho v P; v = 0 */
};
PROBLEM_OWN(layers)

/* n rotated by a right angle in the x-y plane; the x axis if n is along z. */
static void turn(const double n[3], double flow[3])
{
    const double part = hypot(n[0], n[1]);
    flow[0] = part > 0 ? -n[1] / part : 1;
    flow[1] = part > 0 ? n[0] / part : 0;
    flow[2] = 0;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct layers *layers = (struct layers *)p->own.bytes;
    memcpy(layers->gas, settings->value[SETTING_background].real, sizeof layers->gas);
    if (problem_check_state(settings, SETTING_background, error) ||
        problem_direction(p, settings, layers->n, &layers->length, error))
        return error->status;
    turn(layers->n, layers->flow);
    if (layers->gas[1] == 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "background=\"%g %g %g\": layers have a mean velocity of 0; `boost` moves "
                     "them",
                     layers->gas[0], layers->gas[1], layers->gas[2]);
}

/* Sine of the layers' phase at x. */
static double wave_at(const struct prepared *p, const double x[3])
{
    const struct layers *layers = layers_of(p);
    double s = 0;
    for (int d = 0; d < p->domain.dim; d++) s += layers->n[d] * (x[d] - p->domain.lo[d]);
    return sin(2 * M_PI * s / layers->length);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct layers *layers = layers_of(p);
    const double v = speed * wave_at(p, x);
    (void)t;
    *state = (struct problem_state){.rho = layers->gas[0],
                                    .P = layers->gas[2],
                                    .u = layers->gas[2] / ((p->gamma - 1) * layers->gas[0])};
    for (int d = 0; d < p->domain.dim; d++) state->v[d] = v * layers->flow[d];
}

/* Projection on the initial wave, relative to its initial value. */
static double amplitude_measured(const struct prepared *p, const struct snapshot *s)
{
    double sum = 0, whole = 0;
    for (size_t i = 0; i < s->n; i++) {
        double x[3], v[3], along = 0;
        problem_position(p, s, i, x);
        problem_velocity(p, s, i, v);
        for (int d = 0; d < p->domain.dim; d++) along += v[d] * layers_of(p)->flow[d];
        const double wave = wave_at(p, x);
        sum += s->volume[i] * along * wave;
        whole += s->volume[i] * speed * wave * wave;
    }
    return sum / whole;
}

/* Kinematic viscosity that gives the same decay; 0 at the start. */
static double viscosity_measured(const struct prepared *p, const struct snapshot *s)
{
    const double k = 2 * M_PI / layers_of(p)->length;
    return s->time > 0 ? -log(amplitude_measured(p, s)) / (k * k * s->time) : 0;
}

static const struct functional amplitude = {"shear_amplitude", NULL, amplitude_measured,
                                            functional_one},
                               viscosity = {"shear_viscosity", NULL, viscosity_measured,
                                            functional_zero};

const struct problem problem_shear = {
    .member = {"shear", "layers that slide past each other", "Landau & Lifshitz 1987"},
    .reference = "shear",
    .least_dim = 2,
    .most_dim = 3,
    .carried = true,
    .steady = true,
    .smooth = true,
    PROBLEM_KEYS({SETTING_background, ROLE_NEEDED}, {SETTING_direction, ROLE_OPTIONAL}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&amplitude, &viscosity},
};
