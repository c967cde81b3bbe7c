/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whole runs over a few natural time steps in 2D and 3D, with particles that cross the ends of the
 * box, against the oracle: every integrator, with the choices that its steps carry along. */
#include <math.h>

#include "check.h"
#include "hydro_cloud.h"
#include "hydro_setup.h"
#include "integrator.h"
#include "oracle.h"
#include "worst.h"

enum { STEPS = 2 };

struct cloud_steps_subject {
    void (*spoil)(struct setup *setup);
    int dim;
    struct scheme scheme;
};

static struct scheme scheme_of(int dim, const struct integrator *integrator, int c)
{
    struct scheme s = hydro_cloud_scheme(dim);
    s.integrator = integrator;
    s.cfl = integrator->cfl_per_width ? 0.4 : integrator->cfl;
    s.viscosity = c == 0 ? VISCOSITY_TIME_DEPENDENT : VISCOSITY_CONSTANT;
    s.energy = c ? ENERGY_TOTAL : ENERGY_INTERNAL;
    s.gradient = c == 1 ? GRADIENT_IA : c == 2 ? GRADIENT_CORRECTED : GRADIENT_STANDARD;
    s.volume_element = c == 1 ? VOLUME_NUMBER : c == 2 ? VOLUME_ENERGY : VOLUME_MASS;
    s.h_method = c == 1 ? H_PREDICTED : c == 2 ? H_PREDICTED : H_NEWTON;
    if (c == 0) s.balsara = BALSARA_ON;
    if (c == 3) { /* alpha by a switch once a step */
        s.viscosity = VISCOSITY_CULLEN_DEHNEN;
        s.viscosity_form = VISCOSITY_FORM_SIGNAL;
        s.gradient = GRADIENT_IA;
        s.h_method = H_PREDICTED;
    }
    if (c == 2) s.alpha_u = 0.71;
    return s;
}

static void subjects(struct check_run *run)
{
    for (int dim = 2; dim <= 3; dim++)
        for (size_t i = 0; i < integrator_family.n; i++)
            for (int c = 0; c < 4; c++) {
                const struct integrator *integrator =
                    (const struct integrator *)integrator_family.members[i];
                if (dim == 3 && (size_t)c != i % 4) continue;
                const struct cloud_steps_subject subject = {NULL, dim,
                                                            scheme_of(dim, integrator, c)};
                check_subject(run, &subject, sizeof subject);
            }
}

static void judge(struct check_run *run, const struct simulation *simulation,
                  const struct oracle *oracle, const char *where)
{
    struct snapshot got;
    struct simulation_cost cost;
    double x = 0, v = 0, u = 0, rho = 0, P = 0, h = 0, volume = 0;
    const long double kinetic = oracle->scheme.energy == ENERGY_TOTAL ? 0.5L : 0;
    simulation_snapshot(simulation, &got);
    simulation_cost(simulation, &cost);
    for (size_t i = 0; i < got.n; i++) {
        const struct oracle_particle *want = &oracle->particles[got.id[i]];
        long double p2 = 0;
        for (int a = 0; a < oracle->dim; a++) {
            const long double away = got.x[a][i] - want->x[a], period = oracle->period[a];
            worst_keep(&x, (double)fabsl(away - period * roundl(away / period)));
            worst_keep(&v, (double)fabsl(got.v[a][i] - want->p[a] / want->m));
            p2 += want->p[a] * want->p[a];
        }
        worst_keep(&u, (double)fabsl(got.u[i] - (want->e - kinetic * p2 / want->m) / want->m));
        worst_keep(&rho, (double)fabsl(got.rho[i] - want->rho));
        worst_keep(&P, (double)fabsl(got.P[i] - want->P));
        worst_keep(&h, (double)fabsl(got.h[i] - want->h));
        worst_keep(&volume, (double)fabsl(got.volume[i] - want->V));
    }
    if (got.n != oracle->n) x = (double)NAN;
    const double bound = 1e-11, floor = 2e-13;
    check_measure(run, x, bound, floor, "position, %s", where);
    check_measure(run, v, bound, floor, "velocity, %s", where);
    check_measure(run, u, bound, floor, "internal energy, %s", where);
    /* of the state at t_end, whatever the last step has evaluated */
    check_measure(run, rho, bound, floor, "density, %s", where);
    check_measure(run, P, bound, floor, "pressure, %s", where);
    check_measure(run, h, bound, floor, "smoothing length, %s", where);
    check_measure(run, volume, bound, floor, "volume, %s", where);
    check_measure(run, fabs((double)cost.steps - (double)oracle->steps), 0, 0,
                  "number of steps (%zu), %s", oracle->steps, where);
}

static void measure(struct check_run *run, const void *subject)
{
    const struct cloud_steps_subject *given = subject;
    struct cloud_steps_subject s = *given;
    static struct hydro_cloud cloud;
    if (given->spoil) {
        s.dim = 2;
        s.scheme =
            scheme_of(2, hydro_integrator("predicted_midpoint"), given->scheme.viscosity ? 3 : 1);
    }
    hydro_cloud_sheared(&cloud, s.dim, s.dim == 2 ? 8 : 6);
    for (size_t i = 0; i < cloud.n; i++) cloud.v[0][i] -= 1.1; /* through the end of the box */
    struct setup setup = hydro_cloud_setup(&cloud, &s.scheme);
    struct oracle oracle;
    struct simulation *simulation = NULL;
    struct error error = {0};
    char where[CLOUD_TEXT];
    hydro_cloud_describe(&s.scheme, s.dim, where);
    if (!oracle_covers(&s.scheme) || !oracle_covers_step(s.scheme.integrator)) {
        check_skip(run, "%s: the oracle lacks one of these choices", where);
        return;
    }
    enum status status = oracle_create(&oracle, &setup, &error);
    if (!status) {
        status = oracle_evaluate(&oracle, &error);
        const double t_end = (double)oracle_time_step(&oracle) * (STEPS + 0.3);
        if (!status) status = oracle_run(&oracle, t_end, &error);
        if (s.spoil) s.spoil(&setup);
        if (!status) status = simulation_create(&setup, &simulation, &error);
        if (!status) status = simulation_run(simulation, t_end, NULL, NULL, &error);
        if (!status) judge(run, simulation, &oracle, where);
        simulation_destroy(simulation);
        oracle_free(&oracle);
    }
    if (status) check_measure(run, 1, 0, 0, "%s: %s", where, error.message);
}

static void newton(struct setup *setup)
{
    setup->scheme.h_method = H_NEWTON;
}

static void end_taken_for_evaluated(struct setup *setup)
{
    static struct integrator replaced;
    replaced = *setup->scheme.integrator;
    replaced.ends_evaluated = true;
    setup->scheme.integrator = &replaced;
}

static void wider(struct setup *setup)
{
    setup->scheme.eta *= 1 + 1e-6;
}

static void other_cfl(struct setup *setup)
{
    setup->scheme.cfl *= 1 + 1e-6;
}

static void lower_alpha(struct setup *setup)
{
    setup->scheme.alpha_max *= 1 - 1e-6;
}

#define SPOIL(how) (&(const struct cloud_steps_subject){.spoil = how})
#define SPOIL_SWITCH(how)                                                                          \
    (&(const struct cloud_steps_subject){.spoil = how, .scheme.viscosity = VISCOSITY_CULLEN_DEHNEN})
static const struct check_mutant mutants[] = {
    {"cloud_steps_newton", "h by Newton where it is to be predicted", SPOIL(newton)},
    {"cloud_steps_end_not_evaluated", "derived fields of the last midpoint, not of the end",
     SPOIL(end_taken_for_evaluated)},
    {"cloud_steps_eta", "eta too large by 1e-6", SPOIL(wider)},
    {"cloud_steps_cfl", "cfl too large by 1e-6", SPOIL(other_cfl)},
    {"cloud_steps_alpha_max", "what alpha jumps up to too low by 1e-6", SPOIL_SWITCH(lower_alpha)},
    {0},
};

const struct check check_hydro_cloud_steps = {
    .group = "clouds",
    .name = "time_stepping",
    .cost = 2,
    .property = "the state at t_end and the number of steps in 2D and 3D equal the oracle's",
    .subjects = subjects,
    .measure = measure,
    .mutants = mutants,
};
