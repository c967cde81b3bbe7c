/* SPDX-License-Identifier: GPL-3.0-or-later
 * Smooth shear layers with a growing instability (McNally, Lyra & Passy 2012). There is no exact
 * solution after the start, but a reference with many digits for the amplitude of the growing mode.
 * Times scale with the side of the box. Particles of equal spacing whose masses follow the
 * density. */
#include "kelvin_helmholtz.h"

#include <math.h>
#include <stdlib.h>

#include "initial.h"
#include "problem.h"

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    (void)settings;
    return problem_check_square(p, error);
}

/* x in units of the box. */
static void to_unit(const struct prepared *p, const double x[3], double unit[2])
{
    for (int d = 0; d < 2; d++) unit[d] = (x[d] - p->domain.lo[d]) / domain_length(&p->domain, d);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    double unit[2];
    to_unit(p, x, unit);
    const struct kelvin_helmholtz_state s = kelvin_helmholtz_start(unit[0], unit[1]);
    (void)t;
    *state = (struct problem_state){
        .rho = s.rho, .v = {s.v[0], s.v[1]}, .P = s.P, .u = s.P / ((p->gamma - 1) * s.rho)};
}

static double amplitude_measured(const struct prepared *p, const struct snapshot *s)
{
    double *x = malloc(3 * s->n * sizeof *x);
    if (!x) return NAN;
    double *y = x + s->n, *vy = y + s->n;
    for (size_t i = 0; i < s->n; i++) {
        double position[3], unit[2], v[3];
        problem_position(p, s, i, position);
        problem_velocity(p, s, i, v);
        to_unit(p, position, unit);
        x[i] = unit[0];
        y[i] = unit[1];
        vy[i] = v[1];
    }
    const double M = kelvin_helmholtz_amplitude(s->n, x, y, vy, s->volume);
    free(x);
    return M;
}

/* The reference holds for one gamma only. */
static double amplitude_reference(const struct prepared *p, double t)
{
    return fabs(p->gamma - 5. / 3) <= 1e-6
               ? kelvin_helmholtz_reference(t / domain_length(&p->domain, 0))
               : (double)NAN;
}

static const struct functional mode_amplitude = {"mode_amplitude", NULL, amplitude_measured,
                                                 amplitude_reference};

const struct problem problem_kelvin_helmholtz = {
    .member = {"kelvin_helmholtz", "smooth shear layers whose instability grows",
               "McNally, Lyra & Passy 2012"},
    .reference = "kelvin_helmholtz",
    .least_dim = 2,
    .most_dim = 2,
    .carried = true,
    .fieldless = true,
    .smooth = true,
    .shifts_equal_masses = true,
    PROBLEM_KEYS({SETTING_equal_masses, ROLE_PARTICLES}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&mode_amplitude},
};
