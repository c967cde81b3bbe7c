/* SPDX-License-Identifier: GPL-3.0-or-later
 * Uniform gas at rest. Any motion is noise, driven by the initial disorder of the particles, or an
 * instability of their lattice. Particles of equal masses. */
#include "functional.h"
#include "initial.h"
#include "problem.h"

struct gas {
    double rho, v, P;
};
PROBLEM_OWN(gas)

static enum status prepare(struct prepared *p, struct settings *settings, struct error *error)
{
    struct gas *gas = (struct gas *)p->own.bytes;
    const double *background = settings->value[SETTING_background].real;
    *gas = (struct gas){background[0], background[1], background[2]};
    if (problem_check_state(settings, SETTING_background, error)) return error->status;
    if (gas->v == 0) return STATUS_OK;
    return error_set(error, STATUS_BAD_INPUT,
                     "background=\"%g %g %g\": gas at rest has no velocity; `boost` moves it",
                     gas->rho, gas->v, gas->P);
}

static void sample(const struct prepared *p, const double x[3], double t,
                   struct problem_state *state)
{
    const struct gas *gas = gas_of(p);
    (void)x, (void)t;
    *state = (struct problem_state){
        .rho = gas->rho, .P = gas->P, .u = gas->P / ((p->gamma - 1) * gas->rho)};
}

const struct problem problem_rest = {
    .member = {"rest", "uniform gas at rest", ""},
    .reference = "rest",
    .least_dim = 2,
    .most_dim = 3,
    .carried = true,
    .steady = true,
    .smooth = true,
    .ends = {PROBLEM_WALLS, PROBLEM_WALLS, PROBLEM_WALLS},
    PROBLEM_KEYS({SETTING_background, ROLE_NEEDED}),
    .prepare = prepare,
    .sample = sample,
    .fill = initial_fill,
    .functionals = {&functional_velocity_rms},
};
