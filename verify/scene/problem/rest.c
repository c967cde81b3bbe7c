/* SPDX-License-Identifier: GPL-3.0-or-later
 * Uniform gas at rest: nothing may move. What moves is noise, driven by the disorder that particles
 * start with, or an instability of their lattice. Particles of equal masses. */
#include "functional.h"
#include "initial_fill.h"
#include "problem.h"

static const double *gas_of(const struct prepared *p)
{
    return (const double *)p->own.bytes;
}

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    double *gas = (double *)p->own.bytes;
    for (int k = 0; k < 3; k++) gas[k] = settings->value[SETTING_background].real[k];
    if (problem_check_state(settings, SETTING_background, error)) return error->status;
    if (gas[1] == 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "background=\"%g %g %g\": gas at rest has no velocity; `boost` moves it",
                     gas[0], gas[1], gas[2]);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const double *gas = gas_of(p);
    (void)x, (void)t;
    *state =
        (struct problem_state){.rho = gas[0], .P = gas[2], .u = gas[2] / ((p->gamma - 1) * gas[0])};
}

static const struct problem_key keys[] = {{SETTING_background, ROLE_NEEDED}};

const struct problem problem_rest = {
    .member = {"rest", "uniform gas at rest", ""},
    .reference = "rest",
    .least_dim = 2,
    .most_dim = 3,
    .carried = true,
    .smooth = true,
    .ends = {{.also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED)},
             {.also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED)},
             {.also = PROBLEM_END(REFLECTING) | PROBLEM_END(FIXED)}},
    .keys = keys,
    .key_count = sizeof keys / sizeof *keys,
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .random = initial_is_shaken,
    .functionals = {&functional_velocity_rms},
};
